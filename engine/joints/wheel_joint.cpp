#include "engine/joints/wheel_joint.h"

#include "engine/joints/joint_check.h"
#include "engine/math/dual.h"

namespace plumb {

template <class Real>
WheelRows<Real>::WheelRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
    : anchor_a((definition.anchor_a - centre_a).as<Real>()),
      anchor_b((definition.anchor_b - centre_b).as<Real>()),
      axis(unit(definition.axis).template as<Real>()) {}

JointRules rules_of(const WheelDefinition& definition) {
  JointRules rules;
  rules.turn.add_motor(definition.motor);
  rules.axial[0].add_spring(definition.spring, 0);
  rules.axial[0].add_limits(definition.limits);
  rules.axial[1].add({});
  return rules;
}

void validate(const WheelDefinition& definition) {
  const JointCheck check("wheel joint");
  check.finite("anchor_a", definition.anchor_a);
  check.finite("anchor_b", definition.anchor_b);
  check.axis("axis", definition.axis);
  check.spring("spring", definition.spring);
  check.range("limits", definition.limits);
  check.motor("motor", definition.motor);
}

template struct WheelRows<float>;
template struct WheelRows<double>;
template struct WheelRows<Dual>;

}  // namespace plumb
