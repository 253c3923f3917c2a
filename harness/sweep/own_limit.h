#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/result.h"
#include "harness/sweep/space.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness::sweep {

/// Limit of an engine's motion as its steps get finer, to which runs are compared if no answer is known. It
/// shows that the engine is consistent with itself, and nothing about physics.
struct OwnLimit {
  std::string source;  ///< "box2d's own limit, dt 1/7680, within 2.1e-5 m of that at twice the step"
  /// Largest distances of a body's state from that with steps twice as long: errors of the limit itself.
  Metrics within{};
  reference::StepSettings settings{};  ///< of the run that is the limit
  double interval = 0;                 ///< s, from one sample to the next
  std::size_t bodies = 0;
  std::vector<BodyState> states;  ///< sample after sample, from t = 0
  std::string problem;            ///< reason if there is no limit; else empty

  /// Interpolates between samples: positions and angles cubically, velocities linearly.
  void at(double time, std::span<BodyState> out) const;
};

/// Starts the reason of rows of an engine without a limit.
inline constexpr std::string_view kNoLimit = "its solutions do not converge: ";

/// Runs `backend` with finer and finer steps until the next would take more than `seconds`, or until two
/// results differ only by rounding. With `at`, computes the limit of these settings again instead. Each run
/// has a process of its own.
std::shared_ptr<const OwnLimit> find_own_limit(const scenarios::Problem& problem,
                                               const reference::Backend& backend, const Ladder& ladder,
                                               double seconds,
                                               const std::optional<reference::StepSettings>& at = {});

/// Marks a result as one against the engine's own limit. Removes the errors that are smaller than that of the
/// limit: such a run, as the one that is the limit, cannot be told from it.
void hold_against(Result& result, const OwnLimit& limit);

}  // namespace plumb::harness::sweep
