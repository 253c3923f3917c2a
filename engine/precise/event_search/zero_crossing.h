#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace plumb::precise {

/// Finds the first zero crossing in a step: the first time at which one of several functions falls below its
/// own -tolerance. A function that starts at zero, to the tolerance, counts only after it has risen.
struct ZeroCrossing {
  double time = 0;  ///< s: the earliest time, to rounding, at which the value is known to be below -tolerance
  std::size_t index = 0;  ///< of the function
};

/// `evaluate(time, values)` computes all functions' values. They are sampled at `samples` equal parts of the
/// step. Dips between samples are found by parabolas, and roots by the Illinois method with bisection.
std::optional<ZeroCrossing> first_zero_crossing(
    const std::function<void(double, std::span<double>)>& evaluate, std::span<const double> tolerance,
    double start, double end, int samples);

}  // namespace plumb::precise
