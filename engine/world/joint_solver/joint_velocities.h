#pragma once

#include <algorithm>
#include <cmath>

#include "engine/joints/joint_row.h"
#include "engine/math/lanes.h"
#include "engine/world/contact_solver/solver_body.h"

namespace plumb {

/// Velocities and inverse masses of the two bodies of a joint, held in registers while its rows are solved.
template <class Real>
struct JointVelocities {
  Vec2<Real> v_a{}, v_b{};
  Real w_a = 0, w_b = 0;
  Real m_a = 0, i_a = 0, m_b = 0, i_b = 0;  ///< inverse

  template <class Body>
  [[gnu::always_inline]] JointVelocities(const Body& a, const Body& b)
      : v_a(a.velocity),
        v_b(b.velocity),
        w_a(a.angular_velocity),
        w_b(b.angular_velocity),
        m_a(a.inverse_mass),
        i_a(a.inverse_inertia),
        m_b(b.inverse_mass),
        i_b(b.inverse_inertia) {}

  /// Writes the velocities back, except to static and kinematic bodies, which joints of one colour may share.
  void store(SolverBody<Real>& a, SolverBody<Real>& b) const {
    // Copies by component. As a pair, the two halves would be stored separately and loaded together, which
    // stalls.
    if (m_a + i_a > 0) a.velocity.x = v_a.x, a.velocity.y = v_a.y, a.angular_velocity = w_a;
    if (m_b + i_b > 0) b.velocity.x = v_b.x, b.velocity.y = v_b.y, b.angular_velocity = w_b;
  }

  /// Returns J v.
  [[gnu::always_inline]] Real along(const JointRow<Real>& row) const {
    return dot(row.linear_a, v_a) + row.angular_a * w_a + (dot(row.linear_b, v_b) + row.angular_b * w_b);
  }
  /// Returns J_i M^-1 J_j^T.
  [[gnu::always_inline]] Real inverse_mass(const JointRow<Real>& i, const JointRow<Real>& j) const {
    return m_a * dot(i.linear_a, j.linear_a) + i_a * (i.angular_a * j.angular_a) +
           (m_b * dot(i.linear_b, j.linear_b) + i_b * (i.angular_b * j.angular_b));
  }
  /// Applies an impulse: v += M^-1 J^T impulse.
  [[gnu::always_inline]] void apply(const JointRow<Real>& row, Real impulse) {
    v_a += (m_a * impulse) * row.linear_a;
    w_a += i_a * (impulse * row.angular_a);
    v_b += (m_b * impulse) * row.linear_b;
    w_b += i_b * (impulse * row.angular_b);
  }

  /// Returns the velocity of b relative to a at a point.
  [[gnu::always_inline]] Vec2<Real> at(Vec2<Real> arm_a, Vec2<Real> arm_b) const {
    return (v_b + cross(w_b, arm_b)) - (v_a + cross(w_a, arm_a));
  }
  /// Applies `impulse` to b at the point, and its opposite to a.
  [[gnu::always_inline]] void apply(Vec2<Real> impulse, Vec2<Real> arm_a, Vec2<Real> arm_b) {
    v_a -= m_a * impulse;
    w_a -= i_a * cross(arm_a, impulse);
    v_b += m_b * impulse;
    w_b += i_b * cross(arm_b, impulse);
  }
};

/// Largest speed at which iterations close the gap of a rigid row, or an exceeded limit: this number of link
/// lengths a second (joint_opening.h; for angles, rad/s). A gap that bodies keep open, such as that of a load
/// that is caught or of a holder that was moved, would otherwise close within a few substeps: one of 3 m at
/// 200 m/s. With 10, a square held at its centre closes by 4 of its sides a second, as kDepenetrationSpeed
/// pushes overlaps apart. Gaps up to 6 % of a side, at four substeps a step of 1/60 s, close as without it.
inline constexpr double kMaxClosingSpeed = 10;

/// Returns the fraction of a bias velocity, given its square, that is within that speed. The other numbers
/// are squares of the row's coefficients.
template <class Real>
[[gnu::always_inline]] inline Real closing_fraction(const JointVelocities<Real>& v, Real bias_squared,
                                                    Real linear_a, Real angular_a, Real linear_b,
                                                    Real angular_b) {
  using std::min, std::sqrt;
  constexpr Scalar<Real> kSquare = Scalar<Real>(kMaxClosingSpeed * kMaxClosingSpeed);
  const Real fast_a = bias_squared * v.i_a, most_a = kSquare * (v.m_a * linear_a + v.i_a * angular_a);
  const Real fast_b = bias_squared * v.i_b, most_b = kSquare * (v.m_b * linear_b + v.i_b * angular_b);
  Real fraction = 1;
  if (const auto a = fast_a > most_a; any(a)) [[unlikely]]
    fraction = select(a, Real(sqrt(most_a / fast_a)), fraction);
  if (const auto b = fast_b > most_b; any(b)) [[unlikely]]
    fraction = min(fraction, select(b, Real(sqrt(most_b / fast_b)), Real(1)));
  return fraction;
}
template <class Real>
[[gnu::always_inline]] inline Real closing_fraction(const JointVelocities<Real>& v, Real bias_squared,
                                                    const JointRow<Real>& row) {
  return closing_fraction<Real>(v, bias_squared, length_squared(row.linear_a), row.angular_a * row.angular_a,
                                length_squared(row.linear_b), row.angular_b * row.angular_b);
}
/// Reduces the bias velocity of two anchors to that speed.
template <class Real>
[[gnu::always_inline]] inline void limit_closing(const JointVelocities<Real>& v, const AnchorPoint<Real>& at,
                                                 Vec2<Real>& bias) {
  using std::max;
  // Without the arms the limit is lower. Most gaps are below that too, at a fraction of the cost.
  constexpr Scalar<Real> kSquare = Scalar<Real>(kMaxClosingSpeed * kMaxClosingSpeed);
  const Real squared = length_squared(bias);
  const Real excess = max(Real(squared * v.i_a - kSquare * v.m_a), Real(squared * v.i_b - kSquare * v.m_b));
  if (!any(excess > Real(0))) [[likely]]
    return;
  bias = closing_fraction<Real>(v, squared, 1, length_squared(at.arm_a), 1, length_squared(at.arm_b)) * bias;
}

/// Returns the velocities of the bodies of a joint. For a mouse joint those of body a are zero.
template <class Real, class Joint>
[[gnu::always_inline]] inline JointVelocities<Real> velocities_of(const SolverBodies<Real>& bodies,
                                                                  const Joint& joint) {
  JointVelocities<Real> v(bodies.motion[joint.a], bodies.motion[joint.b]);
  if constexpr (Joint::kOneBody) v.v_a = {}, v.w_a = 0, v.m_a = 0, v.i_a = 0;
  return v;
}

/// Displacements and rotations of the two bodies of a joint since the start of the step.
template <class Real>
struct JointMotion {
  Vec2<Real> delta_position_a{}, delta_position_b{};
  Real delta_angle_a = 0, delta_angle_b = 0;
  Rotation<Real> rotation_a{}, rotation_b{};
};

/// Returns the displacements and rotations of the bodies a and b.
template <class Real>
[[gnu::always_inline]] inline JointMotion<Real> motion_of(const SolverBodies<Real>& bodies, int a, int b) {
  const SolverBody<Real>&at_a = bodies.motion[a], &at_b = bodies.motion[b];
  return {at_a.delta_position, at_b.delta_position, at_a.delta_angle,
          at_b.delta_angle,    bodies.rotation[a],  bodies.rotation[b]};
}

/// Time of an evaluation of rows. Motors accumulate their drift from the start of the step in each substep.
enum class JointTime { StepStarts, SubstepEnds, Between };

}  // namespace plumb
