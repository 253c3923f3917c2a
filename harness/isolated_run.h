#pragma once

#include <functional>
#include <optional>
#include <span>

#include "harness/cost.h"
#include "harness/isolate.h"
#include "harness/run.h"

namespace plumb::harness {

/// Result of a run, and the figures that later runs need.
struct IsolatedRun {
  Result result;
  double nanoseconds = 0;  ///< wall time that the engine took for the whole run
  bool interrupted = false;
  std::optional<CostSample> rough;  ///< set if requested and the run is ok
};

/// Description of a run to be made.
struct RunRequest {
  const Case* scene_case = nullptr;
  const reference::Backend* backend = nullptr;
  reference::StepSettings settings{};
  Track* track = nullptr;             ///< may be null
  std::optional<CostBudget> rough{};  ///< if set, measures the cost once, in the same process
};

/// Calls `run` for each request in a process of its own, at most `jobs` at a time. An error, a crash or a
/// hang becomes the result's status. `done` is called as they end.
void run_isolated_all(std::span<const RunRequest> requests, int jobs, double seconds,
                      const std::function<void(std::size_t, IsolatedRun)>& done);

/// Makes one such run.
IsolatedRun run_isolated(const Case& scene_case, const reference::Backend& backend,
                         const reference::StepSettings& settings, Track* track, double seconds);

/// Result of `measure_cost` in a process of its own.
struct IsolatedCost {
  std::optional<CostSample> sample{};  ///< none if the process failed
  bool interrupted = false;
  std::string problem{};  ///< why the process failed
};
IsolatedCost measure_cost_isolated(const Case& scene_case, const reference::Backend& backend,
                                   const reference::StepSettings& settings, double expected_ns_per_step,
                                   const CostBudget& budget, double seconds);

}  // namespace plumb::harness
