#include <fmt/format.h>

#include "harness/known_limits.h"
#include "harness/result.h"

namespace plumb::harness {
namespace {

void judge_check(Result& result, Check& check, bool defaults, std::span<const KnownLimit> limits) {
  const KnownLimit* limit = find_known_limit(limits, result.engine, result.label, check.name, defaults);
  check.known_limit = limit != nullptr && !check.pass ? std::string(limit->reason) : "";
  if (!check.pass && limit == nullptr && !result.excused.empty()) {
    check.known_limit = result.excused;
  } else if (!check.pass && limit == nullptr) {
    result.unexpected.push_back(
        fmt::format("{} is {:.3g}, its bound is {:.3g}", check.name, check.value, check.tolerance));
  }
  if (check.pass && limit != nullptr && defaults && result.excused.empty()) {
    result.unexpected.push_back(fmt::format(
        "known limit has gone: {} meets its bound; remove it from harness/known_limits.cpp", check.name));
  }
}

}  // namespace

void judge(Result& result, bool defaults, std::span<const KnownLimit> limits) {
  result.unexpected.clear();
  const bool broke =
      result.status == Status::Failed || result.status == Status::Crashed || result.status == Status::Timeout;
  if (broke && result.excused.empty()) result.unexpected.push_back(result.reason);
  for (Check& check : result.checks) judge_check(result, check, defaults, limits);
}

}  // namespace plumb::harness
