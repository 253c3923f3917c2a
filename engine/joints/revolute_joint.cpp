#include "engine/joints/revolute_joint.h"

#include "engine/joints/joint_check.h"
#include "engine/math/dual.h"

namespace plumb {

template <class Real>
RevoluteRows<Real>::RevoluteRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
    : anchor_a((definition.anchor_a - centre_a).as<Real>()),
      anchor_b((definition.anchor_b - centre_b).as<Real>()),
      reference(definition.reference_angle) {}

JointRules rules_of(const RevoluteDefinition& definition) {
  JointRules rules;
  rules.turn.add_spring(definition.spring, definition.target_angle);
  rules.turn.add_motor(definition.motor);
  rules.turn.add_limits(definition.limits);
  return rules;
}

void validate(const RevoluteDefinition& definition) {
  const JointCheck check("revolute joint");
  check.finite("anchor_a", definition.anchor_a);
  check.finite("anchor_b", definition.anchor_b);
  check.finite("reference_angle", definition.reference_angle);
  check.range("limits", definition.limits);
  check.motor("motor", definition.motor);
  check.spring("spring", definition.spring);
  check.finite("target_angle", definition.target_angle);
}

template struct RevoluteRows<float>;
template struct RevoluteRows<double>;
template struct RevoluteRows<Dual>;

}  // namespace plumb
