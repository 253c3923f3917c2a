#pragma once

#include "harness/result.h"
#include "harness/track.h"
#include "harness/truth_table.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

/// One instance with what all engines' runs of it share.
struct Case {
  /// `sample`, in s, is how far apart the samples lie on which runs are measured: their dt, or a multiple.
  Case(const scenarios::Instance& instance, double sample);

  scenarios::Instance instance;
  std::string label;
  scenarios::Problem problem;
  TruthTable truth;
};

/// What is known of a run before it starts: names, version, settings; and whether it is skipped.
Result describe(const Case& scene_case, const reference::Backend& backend,
                const reference::StepSettings& settings);

/// Runs `backend` once over the whole duration, samples it where the case has samples, and measures and
/// checks it. `track` (may be null) takes down where the bodies were. `nanoseconds` (may be null) is the wall
/// time that the engine spent. Throws `Error` where the engine does; runs in the caller's own process.
Result run(const Case& scene_case, const reference::Backend& backend, const reference::StepSettings& settings,
           Track* track = nullptr, double* nanoseconds = nullptr);

/// The error of a sample or a distance that counts as diverged, in extents of the scene.
inline constexpr double kDiverged = 1e3;

}  // namespace plumb::harness
