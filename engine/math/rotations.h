#pragma once

#include <span>

namespace plumb {

/// Cosines and sines of many angles, rad, to 4e-16 each: for steps that need no more, at a quarter of the
/// cost of `rotation_of`, with the same bits on every platform. NaN for what is not finite. All three have
/// one size.
void rotations_of(std::span<const double> angles, std::span<double> cosines, std::span<double> sines);

}  // namespace plumb
