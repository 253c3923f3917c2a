#pragma once

#include <vector>

#include "harness/result.h"
#include "harness/run.h"

namespace plumb::harness {

/// How long a cost may be measured for.
struct CostBudget {
  int repetitions = 5;       ///< taking turns with the other engines
  double at_most_ns = 50e6;  ///< of stepping, a repetition; longer runs are measured over their first part
  double at_least_ns = 5e6;  ///< shorter runs are repeated from the start
};

/// One repetition.
struct CostSample {
  double ns_per_step = 0;
  double setup_ns = 0;  ///< the shortest of the set-ups in this repetition
  int steps = 0;        ///< how far into the run it went
};

/// Steps `backend` without looking at its states. `expected_ns_per_step` says how far it gets in the time
/// allowed.
CostSample measure_cost(const Case& scene_case, const reference::Backend& backend,
                        const reference::StepSettings& settings, double expected_ns_per_step,
                        const CostBudget& budget);

/// The median of the samples, with the quartiles.
Cost summarise(const std::vector<CostSample>& samples, double dt);

/// Whether two costs' middle halves lie apart, so that one is really the smaller.
bool clearly_differ(const Cost& a, const Cost& b);

/// Whether the middle half of the repetitions spreads by more than a quarter of the median.
bool is_noisy(const Cost& cost);

}  // namespace plumb::harness
