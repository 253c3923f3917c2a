#pragma once

#include <span>
#include <string>

#include "harness/result.h"
#include "harness/style.h"

namespace plumb::harness {

/// Compares plumb (the world in double) with each rival over all results at the same dt. Lists the scenes in
/// which it is worse, then by how much it is better. Ends with the number of runs that were as expected.
/// Figures below `kRoundingFloor` count as equal.
std::string summary(std::span<const Result> results, const Style& style);

/// Error floor in SI units: rounding errors in double for a scene of some metres and seconds.
inline constexpr double kRoundingFloor = 1e-12;

}  // namespace plumb::harness
