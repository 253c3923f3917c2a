#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "harness/reality/fit.h"
#include "harness/reality/sample.h"

/// Robust fits of laws whose residuals are known with their derivatives by the parameters.
namespace plumb::harness::reality {

/// Difference of a computed value from a measured one, each component weighted so that the length is the
/// error.
struct Residual {
  std::vector<double> off;
  std::vector<double> by{};  ///< derivatives, one row per component; empty if there are none, or no residual
  double error = 0;          ///< length of `off`; infinite if nothing was computed
};

/// Residuals of all measured motions at one time.
using Residuals = std::vector<Residual>;

/// Gradient of the loss, and an upper bound of its second derivatives. The loss is the mean over the times of
/// the logarithm of the middle half's mean error. Each length is weighted by 1 / error (Gauss-Newton
/// approximation).
struct Slope {
  std::vector<double> gradient, curvature;  // row after row
};
Slope slope_of(std::span<const Residuals> times, std::size_t parameters);

/// Solves (C + damping diag C) x = -g by Cholesky's method; parameters that change nothing stay.
std::vector<double> damped_step(const Slope& slope, double damping);

/// Returns fitted values, each with the interval that holds 95 % of the fits to 200 bootstrap samples. These
/// fits minimise the same loss, with residuals that are linear in the parameters about `values`.
std::vector<Estimate> with_intervals(std::span<const double> values, std::span<const Parameter> parameters,
                                     std::span<const Residuals> times, std::uint64_t seed);

}  // namespace plumb::harness::reality
