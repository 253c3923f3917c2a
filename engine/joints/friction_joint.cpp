#include "engine/joints/friction_joint.h"

#include "engine/joints/joint_check.h"

namespace plumb {

template <class Real>
FrictionRows<Real>::FrictionRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
    : anchor_a((definition.anchor_a - centre_a).as<Real>()),
      anchor_b((definition.anchor_b - centre_b).as<Real>()) {}

JointRules rules_of(const FrictionDefinition& definition) {
  JointRules rules;
  rules.point = {.role = RowRole::Motor, .max_force = definition.max_force};
  rules.turn.add({.role = RowRole::Motor, .max_force = definition.max_torque});
  return rules;
}

void validate(const FrictionDefinition& definition) {
  const JointCheck check("friction joint");
  check.finite("anchor_a", definition.anchor_a);
  check.finite("anchor_b", definition.anchor_b);
  check.not_negative("max_force", definition.max_force);
  check.not_negative("max_torque", definition.max_torque);
}

template struct FrictionRows<float>;
template struct FrictionRows<double>;

}  // namespace plumb
