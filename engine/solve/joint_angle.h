#pragma once

#include <cmath>

#include "engine/math/arc_tangent.h"
#include "engine/math/vec2.h"

/// Angles of joints from the rotations of their bodies.
namespace plumb {

inline constexpr double kWholeTurn = 6.28318530717958647692;

/// The angle nearest to `near` that is `angle` but for whole turns.
inline double nearest_turn(double angle, double near) {
  return angle + kWholeTurn * std::floor((near - angle) / kWholeTurn + 0.5);
}

/// rad, in [-pi, pi].
template <class Real>
double angle_of(Rotation<Real> q) {
  return arc_tangent(static_cast<double>(q.s), static_cast<double>(q.c));
}

/// rad, of b relative to a, in [-pi, pi].
template <class Real>
double relative_angle(Rotation<Real> a, Rotation<Real> b) {
  const double c = a.c, s = a.s;
  return arc_tangent(c * b.s - s * b.c, c * b.c + s * b.s);
}

/// The angle of a joint over time: whole turns are counted from substep to substep.
struct JointAngle {
  double a = 0, b = 0;  ///< rad, last seen: of b relative to a in `b`; of geared joints, each body's own
  double start_a = 0, start_b = 0;  ///< the same at the step's start
  double start = 0;                 ///< rad, the joint's own (less its reference) at the step's start
  int known = 0;                    ///< whether a and b have been seen
};

/// What a joint keeps beside impulses: the tooth that a ratchet holds, a pulley's length (m).
struct JointMemory {
  double value = 0;
  int known = 0;
};

}  // namespace plumb
