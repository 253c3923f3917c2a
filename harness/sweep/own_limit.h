#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/sweep/space.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness::sweep {

/// Limit of an engine's motion as its steps get finer, to which runs are compared if no answer is known. It
/// shows that the engine is consistent with itself, and nothing about physics.
struct OwnLimit {
  std::string source;   ///< "box2d's own limit, dt 1/7680, within 2.1e-5 m of that at twice the step"
  double distance = 0;  ///< m, largest distance of a body from its position with steps twice as long
  double interval = 0;  ///< s, from one sample to the next
  std::size_t bodies = 0;
  std::vector<BodyState> states;  ///< sample after sample, from t = 0
  std::string problem;            ///< reason if there is no limit; else empty

  /// Interpolates between samples: positions and angles cubically, velocities linearly.
  void at(double time, std::span<BodyState> out) const;
};

/// Runs `backend` with finer and finer steps until the next would take more than `seconds`, or until two
/// results differ only by rounding. Each run has a process of its own.
std::shared_ptr<const OwnLimit> find_own_limit(const scenarios::Problem& problem,
                                               const reference::Backend& backend, const Ladder& ladder,
                                               double seconds);

}  // namespace plumb::harness::sweep
