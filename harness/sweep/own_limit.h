#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/sweep/space.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness::sweep {

/// What an engine's motion goes to as its steps get finer: what a run is held against where no answer is
/// known. It says how consistent the engine is with itself, and nothing about physics.
struct OwnLimit {
  std::string source;   ///< "box2d's own limit, dt 1/7680, within 2.1e-5 m of that at twice the step"
  double distance = 0;  ///< m, largest distance of a body from where it is at twice the step
  double interval = 0;  ///< s, from one sample to the next
  std::size_t bodies = 0;
  std::vector<BodyState> states;  ///< sample after sample, from t = 0
  std::string problem;            ///< why there is none; else empty

  /// Cubic between samples.
  void at(double time, std::span<BodyState> out) const;
};

/// Runs `backend` with finer and finer steps until the next would take more than `seconds`, or until two
/// differ by rounding. Each run has a process of its own.
std::shared_ptr<const OwnLimit> find_own_limit(const scenarios::Problem& problem,
                                               const reference::Backend& backend, const Ladder& ladder,
                                               double seconds);

}  // namespace plumb::harness::sweep
