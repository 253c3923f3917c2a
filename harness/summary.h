#pragma once

#include <span>
#include <string>

#include "harness/result.h"
#include "harness/style.h"

namespace plumb::harness {

/// How plumb (Realtime, double) stands to each rival over all results at the same dt: first where it is
/// worse, then by how much it is better. Then how many runs were as expected. Figures below `kRoundingFloor`
/// count as equal.
std::string summary(std::span<const Result> results, const Style& style);

/// In SI units: what double rounding leaves of a scene of some metres and seconds.
inline constexpr double kRoundingFloor = 1e-12;

}  // namespace plumb::harness
