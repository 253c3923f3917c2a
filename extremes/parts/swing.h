#pragma once

#include <functional>
#include <memory>
#include <span>

#include "engine/scene/scene.h"
#include "harness/stress/family.h"
#include "scenarios/truth/trajectory.h"

namespace plumb::extremes {

/// angle'' = -k sin(angle) from rest at `start`, rad: a pendulum, solved in extended precision.
class Swing {
 public:
  Swing(double k, double start);

  double angle(double time) const;  ///< rad
  double rate(double time) const;   ///< rad/s

 private:
  std::shared_ptr<const scenarios::truth::Trajectory> path_;
};

/// Returns the exact motion of the rod of `pendulum`. A rod about its end has k = 3 g/(2 L).
harness::stress::Motion swinging(double length, double angle, Vec2d pivot = {});

/// Returns the potential energy that the rod of `pendulum` releases when it swings down from `angle`, J:
/// m g L (1 - cos(angle))/2, with mass L^2.
double swing_energy(double length, double angle);

/// The rod of `pendulum` at 60 degrees, for two periods: its hinge's gap stays within 1 % of its length, its
/// energy within 5 % of `swing_energy`, and its position within 10 % of its length.
harness::stress::Trial swinging_rod(std::string name, double length, Vec2d pivot, double dt);

}  // namespace plumb::extremes
