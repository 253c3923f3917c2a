#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace plumb::precise {

/// The first time in a step at which one of several functions falls below its own -tolerance. A function that
/// starts at zero, to its tolerance, is watched all the same: what is about to rise has to rise.
struct Fall {
  double time = 0;        ///< s: the first that is known to lie beyond, to rounding
  std::size_t index = 0;  ///< of the function
};

/// `evaluate(time, values)` fills all functions' values. They are sampled at `samples` equal parts of the
/// step, dips between samples are looked for by parabolas, and roots are located by the Illinois method with
/// bisection.
std::optional<Fall> first_fall(const std::function<void(double, std::span<double>)>& evaluate,
                               std::span<const double> tolerance, double start, double end, int samples);

}  // namespace plumb::precise
