#pragma once

#include <string>

#include "engine/scene/scene.h"

/// What the thresholds' scenes are put together from.
namespace plumb::harness::thresholds {

/// m/s^2
inline constexpr double kGravity = 9.81;

/// A box of even density 1 kg/m^2.
Body block(std::string name, double width, double height, Vec2d position, double friction, double angle = 0);

/// `body`, held where it is.
Body held(Body body);

/// A half plane that rises to the right, with its surface through the origin.
class Slope {
 public:
  explicit Slope(double angle);  ///< rad

  double angle() const { return angle_; }
  /// A point `along` uphill from the origin and `above` the surface, m.
  Vec2d at(double along, double above) const { return along * uphill_ + above * normal_; }
  /// How far uphill of the origin a point is, m.
  double along(Vec2d point) const { return dot(point, uphill_); }
  /// The ground, 200 m long.
  Body ground(double friction) const;

 private:
  double angle_;
  Vec2d uphill_, normal_;
};

/// Seconds until what starts to slip at rest, with `acceleration` in m/s^2, is twice `way` (m) farther than
/// where it was at `kSettled`.
double time_to_slip(double way, double acceleration);

inline constexpr double kSettled = 1;  ///< s, in which an engine's contacts may find their place

/// Seconds until something of which the centre of mass stands `offset` beside the vertical through its pivot
/// is tilted by `tilt`, half as long again: phi'' = rate^2 (phi + offset / arm) from rest, so
/// phi = (offset / arm) (cosh(rate t) - 1) with rate^2 = g arm / gyration_squared, `arm` and
/// `gyration_squared` (m, m^2) being taken about the pivot.
double time_to_tilt(double offset, double arm, double gyration_squared, double tilt);

/// rad, that counts as toppled.
inline constexpr double kToppled = 0.05;

}  // namespace plumb::harness::thresholds
