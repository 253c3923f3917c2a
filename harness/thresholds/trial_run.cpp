#include "harness/thresholds/trial_run.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "harness/isolate.h"

namespace plumb::harness::thresholds {
namespace {

bool finite(const BodyState& state) {
  return std::isfinite(state.position.x + state.position.y + state.angle + state.velocity.x +
                       state.velocity.y + state.angular_velocity);
}

}  // namespace

Answer run_trial(const Trial& trial, const reference::Backend& backend,
                 const reference::StepSettings& settings) {
  const auto simulator = backend.create(trial.scene, settings);
  std::vector<BodyState> states(trial.scene.bodies.size());
  const auto steps = static_cast<long>(std::ceil(trial.duration / settings.dt));
  for (long step = 1; step <= steps; ++step) {
    simulator->advance(1);
    simulator->read(states);
    const double time = static_cast<double>(step) * settings.dt;
    if (!std::ranges::all_of(states, finite))
      return {false, fmt::format("is not finite after {:.2g} s", time)};
    if (std::string why = trial.broke(time, states); !why.empty()) return {false, why};
  }
  return {true, ""};
}

Answer run_isolated(const Threshold& threshold, double value, double resolution,
                    const reference::Backend& backend, const reference::StepSettings& settings,
                    double seconds) {
  const auto work = [&]() -> std::string {
    const Trial trial = threshold.build(value, resolution);
    if (const std::string reason = backend.unsupported(trial.scene, settings); !reason.empty())
      return "refused: " + reason;
    return run_trial(trial, backend, settings).why;
  };
  const Outcome outcome = isolate(work, seconds);
  switch (outcome.kind) {
    case Outcome::Kind::Done:
      return {outcome.text.empty(), outcome.text};
    case Outcome::Kind::Failed:
      return {false, "error: " + outcome.text};
    case Outcome::Kind::Crashed:
      return {false, "crashed: " + outcome.text};
    case Outcome::Kind::Timeout:
    case Outcome::Kind::Interrupted:
      break;
  }
  return {false, outcome.text};
}

}  // namespace plumb::harness::thresholds
