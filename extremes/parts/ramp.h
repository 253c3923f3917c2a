#pragma once

#include "extremes/parts/scenes.h"

namespace plumb::extremes {

inline constexpr double kSlope = std::numbers::pi / 6;  // rad

/// A body is released on a slope of 30 degrees, its centre `height`, m, above it. With the friction
/// coefficient `friction` it accelerates down by `acceleration`, m/s^2. Its error may be at most 5 % of the
/// displacement without friction in 1 s.
Trial on_a_slope(std::string name, const Geometry& geometry, double height, double friction,
                 double acceleration);

}  // namespace plumb::extremes
