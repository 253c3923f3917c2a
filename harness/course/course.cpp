#include "harness/course/course.h"

#include <cmath>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "reference/process_backend.h"

namespace plumb::course {
namespace {

using reference::ProcessError;

bool is_timeout(const Error& error) {
  const auto* process = dynamic_cast<const ProcessError*>(&error);
  return process != nullptr && process->fault() == ProcessError::Fault::Timeout;
}

Finding not_yet(const Check& check, const std::string& reason) {
  Finding out;
  out.verdict = Verdict::NotYet;
  out.says = fmt::format("{}. This check wants {}", reason, check.wants);
  return out;
}

Finding broken(const std::string& says) {
  Finding out;
  out.verdict = Verdict::Broken;
  out.says = says;
  return out;
}

Finding run(const Check& check, const Lab& lab, int& timeouts) {
  try {
    Finding out = check.run(lab);
    for (const Reading& reading : out.readings)
      if (!std::isfinite(reading.measured))
        return broken(fmt::format("{} is not a finite number", reading.what));
    return out;
  } catch (const NotYet& reason) {
    return not_yet(check, reason.what());
  } catch (const Error& error) {
    if (error.kind() == Error::Kind::Unsupported) return not_yet(check, error.what());
    if (is_timeout(error)) ++timeouts;
    return broken(error.what());
  }
}

}  // namespace

std::vector<Chapter> chapters() {
  return {bouncing_ball(), cannonballs(), circle_collisions(), rotation_and_boxes(),
          constraints_and_ragdoll()};
}

std::vector<Outcome> examine(const reference::Backend& engine, const reference::StepSettings& settings,
                             std::span<const Chapter> chapters,
                             const std::function<void(const Outcome&)>& done) {
  const Lab lab(engine, settings);
  std::vector<Outcome> out;
  int timeouts = 0;
  for (const Chapter& chapter : chapters) {
    for (const Check& check : chapter.checks) {
      Outcome outcome{.chapter = &chapter, .check = &check, .finding = {}};
      outcome.finding = timeouts >= kPatience
                            ? broken(fmt::format("not tried: the engine has hung {} times", timeouts))
                            : run(check, lab, timeouts);
      done(outcome);
      out.push_back(std::move(outcome));
    }
  }
  return out;
}

}  // namespace plumb::course
