#pragma once

#include <vector>

#include "harness/result.h"
#include "harness/run.h"

namespace plumb::harness {

/// Limits on the time spent on measuring a cost.
struct CostBudget {
  int repetitions = 5;       ///< in turns with the other engines
  double at_most_ns = 50e6;  ///< of stepping, per repetition; longer runs are measured over their first part
  double at_least_ns = 5e6;  ///< shorter runs are repeated
};

/// One repetition.
struct CostSample {
  double ns_per_step = 0;
  double setup_ns = 0;  ///< the shortest set-up in this repetition
  int steps = 0;        ///< steps of the run that were made
};

/// Steps `backend` without reading its states. `expected_ns_per_step` determines how many steps fit into the
/// budget.
CostSample measure_cost(const Case& scene_case, const reference::Backend& backend,
                        const reference::StepSettings& settings, double expected_ns_per_step,
                        const CostBudget& budget);

/// Returns the median of the samples, with the quartiles.
Cost summarise(const std::vector<CostSample>& samples, double dt);

/// Returns true if the interquartile ranges of the two costs do not overlap.
bool clearly_differ(const Cost& a, const Cost& b);

/// Returns true if the interquartile range of the repetitions exceeds a quarter of the median.
bool is_noisy(const Cost& cost);

}  // namespace plumb::harness
