#pragma once

#include <cmath>

#include "engine/joints/joint_row.h"

namespace plumb {

/// Two anchors at a distance: q = |d|, d from anchor a to anchor b. dq/dt = u . dd/dt, u = d / |d|.
template <class Real>
struct DistanceRows : JointTraits<0, 1> {
  using Definition = DistanceDefinition;
  static constexpr bool kLength = true;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames

  DistanceRows() = default;
  DistanceRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
      : anchor_a((definition.anchor_a - centre_a).as<Real>()),
        anchor_b((definition.anchor_b - centre_b).as<Real>()) {}

  [[gnu::always_inline]] void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    const AnchorPoint<Real> point = anchor_point(pose, anchor_a, anchor_b);
    using std::sqrt;
    const Real length = sqrt(length_squared(point.gap));
    // Coinciding anchors have no direction: any one separates them.
    const auto apart = length > Real(0);
    const Real inverse = Real(1) / length;
    const Vec2<Real> u{select(apart, Real(inverse * point.gap.x), Real(1)),
                       select(apart, Real(inverse * point.gap.y), Real(0))};
    out.axial[0] = point.row(u, length);
    out.arm_b = point.arm_b;
  }
};

inline JointRules rules_of(const DistanceDefinition& definition) {
  JointRules rules;
  RowRules& along = rules.axial[0];
  along.add_spring(definition.spring, definition.length);
  along.add_motor(definition.motor);
  along.add_limits(definition.range);
  if (!definition.spring && !definition.range) along.add({.origin = definition.length});
  return rules;
}

}  // namespace plumb
