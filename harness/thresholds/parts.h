#pragma once

#include <string>

#include "engine/scene/scene.h"

/// Parts of the thresholds' scenes.
namespace plumb::harness::thresholds {

/// m/s^2
inline constexpr double kGravity = 9.81;

/// Returns a box of uniform density 1 kg/m^2.
Body block(std::string name, double width, double height, Vec2d position, double friction, double angle = 0);

/// Returns `body` as a static body.
Body held(Body body);

/// A half plane that rises to the right, with its surface through the origin.
class Slope {
 public:
  explicit Slope(double angle);  ///< rad

  double angle() const { return angle_; }
  /// Returns the point `along` uphill from the origin and `above` the surface, m.
  Vec2d at(double along, double above) const { return along * uphill_ + above * normal_; }
  /// Returns the distance of a point uphill from the origin, m.
  double along(Vec2d point) const { return dot(point, uphill_); }
  /// Returns the ground, 200 m long.
  Body ground(double friction) const;

 private:
  double angle_;
  Vec2d uphill_, normal_;
};

/// Returns the time, s, at which a body that slips from rest with `acceleration`, m/s^2, has moved by 2 `way`
/// (m) since `kSettled`.
double time_to_slip(double way, double acceleration);

inline constexpr double kSettled = 1;  ///< s, in which an engine's contacts settle

/// Returns 1.5 times the time, s, in which a body tilts by `tilt`. Its centre of mass is `offset` beside the
/// vertical through its pivot. From rest phi'' = rate^2 (phi + offset / arm), so phi = (offset / arm)
/// (cosh(rate t) - 1) with rate^2 = g arm / gyration_squared. `arm` and `gyration_squared` (m, m^2) are about
/// the pivot.
double time_to_tilt(double offset, double arm, double gyration_squared, double tilt);

/// Tilt that counts as toppled, rad.
inline constexpr double kToppled = 0.05;

}  // namespace plumb::harness::thresholds
