#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace plumb::precise {

/// First zero crossing: the first time in a step at which one of several functions falls below its own
/// -tolerance. Functions that start at zero, to the tolerance, are included: they must rise.
struct Fall {
  double time = 0;        ///< s: the first time known to lie beyond, to rounding
  std::size_t index = 0;  ///< of the function
};

/// `evaluate(time, values)` computes all functions' values. They are sampled at `samples` equal parts of the
/// step. Dips between samples are found by parabolas, and roots by the Illinois method with bisection.
std::optional<Fall> first_zero_crossing(const std::function<void(double, std::span<double>)>& evaluate,
                                        std::span<const double> tolerance, double start, double end,
                                        int samples);

}  // namespace plumb::precise
