#pragma once

#include "extremes/parts/scenes.h"

namespace plumb::extremes {

inline constexpr double kSlope = std::numbers::pi / 6;  // rad

/// A body let go on a slope of 30 degrees, its centre `height`, m, above it, with the friction coefficient
/// `friction` between them: it comes down with `acceleration`, m/s^2. Off by at most 5 % of what it would
/// slide without friction in 1 s.
Trial on_a_slope(std::string name, const Geometry& geometry, double height, double friction,
                 double acceleration);

}  // namespace plumb::extremes
