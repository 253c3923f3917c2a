#include "harness/sweep/cases.h"

#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "engine/scene/error.h"

namespace plumb::harness::sweep {

Cases::Cases(scenarios::Instance instance, Ladder ladder, double seconds)
    : instance_(std::move(instance)),
      ladder_(ladder),
      seconds_(seconds),
      has_truth_(static_cast<bool>(instance_.build().truth.exact)) {}

Cases::Own& Cases::own(const reference::Backend& backend) {
  const auto [place, fresh] = own_.try_emplace(std::string(backend.name()));
  Own& own = place->second;
  if (!fresh) return own;
  std::optional<reference::StepSettings> at;
  if (const auto taken = taken_.find(place->first); taken != taken_.end()) at = taken->second;
  own.limit = find_own_limit(instance_.build(), backend, ladder_, seconds_, at);
  own.scenario = *instance_.scenario;
  own.scenario.build = [build = instance_.scenario->build, limit = own.limit](std::string_view variant,
                                                                              int size) {
    scenarios::Problem problem = build(variant, size);
    problem.truth = {.source = limit->source,
                     .exact = [limit](double time, std::span<BodyState> out) { limit->at(time, out); }};
    return problem;
  };
  return own;
}

void Cases::take_limit(const reference::Backend& backend, const reference::StepSettings& settings) {
  taken_[std::string(backend.name())] = settings;
}

const OwnLimit& Cases::limit(const reference::Backend& backend) { return *own(backend).limit; }

const Case& Cases::sampled(const reference::Backend& backend, double sample) {
  auto& known = cases_[{has_truth_ ? std::string() : std::string(backend.name()), sample}];
  if (known) return *known;
  scenarios::Instance instance = instance_;
  if (!has_truth_) {
    Own& mine = own(backend);
    if (!mine.limit->problem.empty())
      throw Error(Error::Kind::Run, fmt::format("engine '{}'", backend.name()), "own limit", "",
                  mine.limit->problem);
    instance.scenario = &mine.scenario;
  }
  known = std::make_unique<Case>(instance, sample);
  return *known;
}

}  // namespace plumb::harness::sweep
