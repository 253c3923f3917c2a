#include "engine/joints/distance_joint.h"

#include "engine/joints/joint_check.h"
#include "engine/math/dual.h"

namespace plumb {

template <class Real>
DistanceRows<Real>::DistanceRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
    : anchor_a((definition.anchor_a - centre_a).as<Real>()),
      anchor_b((definition.anchor_b - centre_b).as<Real>()) {}

JointRules rules_of(const DistanceDefinition& definition) {
  JointRules rules;
  RowRules& along = rules.axial[0];
  along.add_spring(definition.spring, definition.length);
  along.add_motor(definition.motor);
  along.add_limits(definition.range);
  if (!definition.spring && !definition.range) along.add({.origin = definition.length});
  return rules;
}

void validate(const DistanceDefinition& definition) {
  const JointCheck check("distance joint");
  check.finite("anchor_a", definition.anchor_a);
  check.finite("anchor_b", definition.anchor_b);
  check.positive("length", definition.length);
  check.spring("spring", definition.spring);
  check.motor("motor", definition.motor);
  check.range("range", definition.range);
  if (definition.range && definition.range->upper < 0)
    check.refuse("range.upper", definition.range->upper, "must not be negative: a distance never is");
  if (definition.motor && !definition.spring && !definition.range)
    check.refuse("motor.speed", definition.motor->speed,
                 "has nothing to move: a rod's length is fixed; give a spring or a range");
}

template struct DistanceRows<float>;
template struct DistanceRows<double>;
template struct DistanceRows<Dual>;

}  // namespace plumb
