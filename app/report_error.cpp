#include "app/report_error.h"

#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "app/exit_codes.h"
#include "app/output.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/interrupt.h"

namespace plumb::app {
namespace {

int report(const std::string& text, int code) {
  notice(text);
  return code;
}

std::string what_next(const Error& error) {
  if (error.kind() != Error::Kind::Name) return "";
  if (error.subject().starts_with("scenario")) return "; `plumb list` shows the scenarios";
  if (error.subject().starts_with("threshold")) return "; see `plumb thresholds --list`";
  if (error.subject().starts_with("engine")) return "; `plumb engines` shows the engines";
  return "";
}

}  // namespace

int reporting_errors(const std::function<int()>& action) {
  try {
    const int code = action();
    flush();
    return code;
  } catch (const OutputClosed&) {
    return kOk;
  } catch (const UsageError& error) {
    return report(error.what(), kUsage);
  } catch (const Error& error) {
    if (harness::interrupted()) return kInterrupted;
    return report(error.what() + what_next(error), error.kind() == Error::Kind::Run ? kCheckFailed : kUsage);
  } catch (const std::bad_alloc&) {
    return report("there is not enough memory for this scene", kCheckFailed);
  } catch (const std::system_error& error) {
    return report(error.what(), kUsage);
  } catch (const std::exception& error) {
    return report(error.what(), kCheckFailed);
  }
}

}  // namespace plumb::app
