#pragma once

#include <cmath>

#include "engine/math/arc_tangent.h"
#include "engine/math/vec2.h"

/// Angles of joints from the rotations of their bodies.
namespace plumb {

inline constexpr double kTwoPi = 6.28318530717958647692;

/// Returns `angle` plus the whole turns that bring it nearest to `near`.
inline double unwrap_angle(double angle, double near) {
  return angle + kTwoPi * std::floor((near - angle) / kTwoPi + 0.5);
}

/// Returns the angle of a rotation, rad, in [-pi, pi].
template <class Real>
double angle_of(Rotation<Real> q) {
  return arc_tangent(static_cast<double>(q.s), static_cast<double>(q.c));
}

/// Returns the angle of b relative to a, rad, in [-pi, pi].
template <class Real>
double relative_angle(Rotation<Real> a, Rotation<Real> b) {
  const double c = a.c, s = a.s;
  return arc_tangent(c * b.s - s * b.c, c * b.c + s * b.s);
}

/// Returns the initial angle of a joint placed at `angle`, rad, up to whole turns. It is the one nearest to 0
/// or, if limits exclude that, the one that violates them least. A pose does not contain the number of turns,
/// so every driver starts counting here.
inline double angle_at_creation(double angle, double lower, double upper) {
  constexpr double kSlack = 0.01;  // rad: a joint placed at a limit may exceed it by rounding
  const double near = unwrap_angle(angle, 0);
  if (near >= lower - kSlack && near <= upper + kSlack) return near;
  // The first turn that reaches the range, and the one on the range's other side.
  const double turns =
      near < lower ? std::ceil((lower - near) / kTwoPi) : std::floor((upper - near) / kTwoPi);
  const double beyond = near + kTwoPi * turns, before = beyond + (near < lower ? -kTwoPi : kTwoPi);
  const auto passed = [&](double x) { return std::fmax(std::fmax(lower - x, x - upper), 0.0); };
  return passed(beyond) <= passed(before) ? beyond : before;
}

/// State of a joint's count of turns.
enum class TurnCount : int {
  New,      ///< not counted: the turn is that of `angle_at_creation`
  Counted,  ///< the joint's angle is near the last one
  Limited,  ///< the same, with new limits: the turn nearest to the allowed range
};

/// The angle of a joint over time; whole turns are counted from substep to substep.
struct JointAngle {
  double a = 0, b = 0;  ///< rad, last evaluated: of b relative to a in `b`; of geared joints, each body's own
  double start_a = 0, start_b = 0;  ///< the same at the start of the step
  double start = 0;                 ///< rad, the joint's own (minus its reference) at the start of the step
  TurnCount count = TurnCount::New;
};

/// State of a joint besides impulses: the tooth that a ratchet holds, a pulley's length (m).
struct JointMemory {
  double value = 0;
  int known = 0;
};

}  // namespace plumb
