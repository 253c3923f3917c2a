#pragma once

#include <functional>
#include <span>
#include <vector>

namespace plumb::harness::reality {

/// Parameter of a law: searched from `start`, in first steps of `step`, between `low` and `high`.
struct Parameter {
  const char* name = "";
  const char* unit = "";  ///< empty: a number
  double start = 0, step = 1, low = 0, high = 1;
};

struct Fit {
  std::vector<double> values;  ///< by parameter
  double loss = 0;
};

/// Returns the parameters with the least `loss`, by Nelder and Mead's simplex (Computer Journal 7 (1965)
/// 308), restarted from its result, because such losses have kinks. At most `evaluations` calls of `loss`.
Fit minimise(std::span<const Parameter> parameters, int evaluations,
             const std::function<double(std::span<const double>)>& loss);

}  // namespace plumb::harness::reality
