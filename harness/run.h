#pragma once

#include <string_view>

#include "harness/result.h"
#include "harness/track.h"
#include "harness/truth_table.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

/// One instance, with the data that the runs of all engines share.
struct Case {
  /// `sample`, in s: distance between the samples that runs are measured on, dt or a multiple.
  Case(const scenarios::Instance& instance, double sample);

  scenarios::Instance instance;
  std::string label;
  scenarios::Problem problem;
  TruthTable truth;
};

/// Returns the facts known before a run starts: names, version, settings, and the reason if it is skipped.
Result describe(const Case& scene_case, const reference::Backend& backend,
                const reference::StepSettings& settings);

/// Runs `backend` once over the whole duration, samples it at the case's samples, and measures and checks it.
/// `track` (may be null) records the bodies' positions. `nanoseconds` (may be null) returns the engine's wall
/// time. Throws `Error` if the engine does; runs in the caller's own process.
Result run(const Case& scene_case, const reference::Backend& backend, const reference::StepSettings& settings,
           Track* track = nullptr, double* nanoseconds = nullptr);

/// Explains why a guest's miss is not a failure; see `reference::Identity::guest`.
inline constexpr std::string_view kGuest = "measured, not required: this engine declares no limits";

/// Limit of a sample's error or distance, in extents of the scene; beyond it the run counts as diverged.
inline constexpr double kDiverged = 1e3;

}  // namespace plumb::harness
