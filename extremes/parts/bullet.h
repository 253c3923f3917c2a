#pragma once

#include "extremes/parts/scenes.h"

namespace plumb::extremes {

/// Shape and orientation of a bullet.
struct Bullet {
  Geometry geometry{};
  double angle = 0;  ///< rad
  double reach = 0;  ///< m, from its centre to the point that hits
};

inline constexpr double kFlight = 2.5;  // steps until it hits
inline constexpr int kSteps = 10;

/// A bullet of `speed`, m/s, hits a wall of `thickness`, m, whose front is at x = 0, and comes back:
/// restitution 1, no friction, no gravity. It must not get beyond the wall's middle, fly at its speed before
/// (within 1 %), and as fast backwards after (within 5 %).
Trial shot(std::string name, const Bullet& bullet, double speed, double thickness);

/// Two such bullets meet at x = 0 and exchange their velocities; neither may pass the other.
Trial two_shots(std::string name, const Bullet& bullet, double speed);

}  // namespace plumb::extremes
