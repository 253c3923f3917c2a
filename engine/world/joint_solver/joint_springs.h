#pragma once

#include "engine/joints/spring_stiffness.h"
#include "engine/world/joint_solver/joint_point.h"

namespace plumb {

/// Mobilities that a joint's springs refer to, and the masses of the bodies for which they were computed.
template <class Real>
struct JointSprings {
  bool any = false;             ///< the joint has springs
  bool known = false;           ///< `mobility` is that of `bodies`
  PairMobility<Real> bodies{};  ///< inverse masses and moments of inertia
  SpringMobility mobility{};    ///< at the joint's reference

  /// Returns true if they are right for the masses of the bodies.
  bool fit(const PairMobility<Real>& now) const { return !any || (known && bodies == now); }
};

inline bool has_springs(const JointRules& rules) {
  return rules.angular.has(RowRole::Spring) || rules.axial[0].has(RowRole::Spring) ||
         rules.axial[1].has(RowRole::Spring) || rules.point.role == RowRole::Spring;
}

/// Returns the inverse masses and moments of inertia of a joint's bodies.
template <class Real>
[[gnu::always_inline]] inline PairMobility<Real> masses_of(const JointVelocities<Real>& v) {
  return {v.m_a, v.i_a, v.m_b, v.i_b};
}

/// Returns the response of a point while the bodies do not rotate relative to each other.
template <class Real>
[[gnu::always_inline]] inline PointResponse<Real> constrained_response(const PairMobility<Real>& pair,
                                                                       const AnchorPoint<Real>& point) {
  const Real m = pair.m_a + pair.m_b, rotational = common_rotation_mobility(pair);
  const Vec2<Real> p = perpendicular(point.arm_b - point.arm_a);
  return {m + rotational * p.x * p.x, rotational * p.x * p.y, m + rotational * p.y * p.y,
          m * (m + rotational * length_squared(p))};
}

}  // namespace plumb
