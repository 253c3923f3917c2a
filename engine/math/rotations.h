#pragma once

#include <span>

namespace plumb {

/// Computes cosines and sines of many angles, rad, to 4e-16 each: at a quarter of the cost of `rotation_of`,
/// with the same bits on every platform. NaN for non-finite angles. All three spans have the same size.
void rotations_of(std::span<const double> angles, std::span<double> cosines, std::span<double> sines);

}  // namespace plumb
