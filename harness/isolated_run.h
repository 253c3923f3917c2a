#pragma once

#include <functional>
#include <optional>
#include <span>

#include "harness/cost.h"
#include "harness/isolate.h"
#include "harness/run.h"

namespace plumb::harness {

/// A run, and what it takes to go on with it.
struct IsolatedRun {
  Result result;
  double nanoseconds = 0;  ///< that the engine spent on the whole run
  bool interrupted = false;
  std::optional<CostSample> rough;  ///< where it was asked for and the run is ok
};

/// A run that is to be made.
struct RunRequest {
  const Case* scene_case = nullptr;
  const reference::Backend* backend = nullptr;
  reference::StepSettings settings{};
  Track* track = nullptr;             ///< may be null
  std::optional<CostBudget> rough{};  ///< measures the cost once, in the same process
};

/// `run`, each in a process of its own and at most `jobs` at a time: an error, a crash or a hang becomes the
/// result's status. `done` is called as they end.
void run_isolated_all(std::span<const RunRequest> requests, int jobs, double seconds,
                      const std::function<void(std::size_t, IsolatedRun)>& done);

/// One of them.
IsolatedRun run_isolated(const Case& scene_case, const reference::Backend& backend,
                         const reference::StepSettings& settings, Track* track, double seconds);

/// `measure_cost` in a process of its own.
struct IsolatedCost {
  std::optional<CostSample> sample;  ///< none where the process did not end well
  bool interrupted = false;
};
IsolatedCost measure_cost_isolated(const Case& scene_case, const reference::Backend& backend,
                                   const reference::StepSettings& settings, double expected_ns_per_step,
                                   const CostBudget& budget, double seconds);

}  // namespace plumb::harness
