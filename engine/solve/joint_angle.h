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

/// rad, of a joint that is put together at `angle` but for whole turns: the one nearest to 0, or, where
/// limits do not allow that, the one that passes them least. A pose does not tell how often a body has
/// turned: what it was made with is what it is held at. Every driver starts counting here.
inline double angle_at_birth(double angle, double lower, double upper) {
  constexpr double kSlack = 0.01;  // rad: a joint placed at a limit may pass it by roundings
  const double near = nearest_turn(angle, 0);
  if (near >= lower - kSlack && near <= upper + kSlack) return near;
  // The first turn within reach of the range, and the one on the range's other side.
  const double turns =
      near < lower ? std::ceil((lower - near) / kWholeTurn) : std::floor((upper - near) / kWholeTurn);
  const double beyond = near + kWholeTurn * turns,
               before = beyond + (near < lower ? -kWholeTurn : kWholeTurn);
  const auto passed = [&](double x) { return std::fmax(std::fmax(lower - x, x - upper), 0.0); };
  return passed(beyond) <= passed(before) ? beyond : before;
}

/// What is known of the turns that a joint has come.
enum class TurnCount : int {
  Born,     ///< nothing: the turn is that of `angle_at_birth`
  Counted,  ///< the joint's angle is near the last one
  Limited,  ///< the same, with limits that are new: the turn is the nearest one to what they allow
};

/// The angle of a joint over time: whole turns are counted from substep to substep.
struct JointAngle {
  double a = 0, b = 0;  ///< rad, last seen: of b relative to a in `b`; of geared joints, each body's own
  double start_a = 0, start_b = 0;  ///< the same at the step's start
  double start = 0;                 ///< rad, the joint's own (less its reference) at the step's start
  TurnCount count = TurnCount::Born;
};

/// What a joint keeps beside impulses: the tooth that a ratchet holds, a pulley's length (m).
struct JointMemory {
  double value = 0;
  int known = 0;
};

}  // namespace plumb
