#include "engine/joints/motor_joint.h"

#include "engine/joints/joint_check.h"
#include "engine/math/dual.h"

namespace plumb {

template <class Real>
MotorRows<Real>::MotorRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
    : anchor_a((definition.target_position - centre_a).as<Real>()),
      anchor_b((-centre_b).as<Real>()),
      reference(definition.target_angle) {}

JointRules rules_of(const MotorDefinition& definition) {
  JointRules rules;
  rules.point = {.role = RowRole::Spring, .spring = definition.spring, .max_force = definition.max_force};
  rules.turn.add({.role = RowRole::Spring, .spring = definition.spring, .max_force = definition.max_torque});
  return rules;
}

void validate(const MotorDefinition& definition) {
  const JointCheck check("motor joint");
  check.finite("target_position", definition.target_position);
  check.finite("target_angle", definition.target_angle);
  check.not_negative("max_force", definition.max_force);
  check.not_negative("max_torque", definition.max_torque);
  check.spring("spring", definition.spring);
}

template struct MotorRows<float>;
template struct MotorRows<double>;
template struct MotorRows<Dual>;

}  // namespace plumb
