#include "engine/joints/weld_joint.h"

#include "engine/joints/joint_check.h"
#include "engine/math/dual.h"

namespace plumb {

template <class Real>
WeldRows<Real>::WeldRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
    : anchor_a((definition.anchor_a - centre_a).as<Real>()),
      anchor_b((definition.anchor_b - centre_b).as<Real>()),
      reference(definition.reference_angle) {}

template <class Real>
SoftWeldRows<Real>::SoftWeldRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
    : anchor_a((definition.anchor_a - centre_a).as<Real>()),
      anchor_b((definition.anchor_b - centre_b).as<Real>()),
      reference(definition.reference_angle) {}

JointRules rules_of(const WeldDefinition& definition) {
  JointRules rules;
  if (definition.linear_spring) rules.point = {.role = RowRole::Spring, .spring = *definition.linear_spring};
  RowRule turn;
  if (definition.angular_spring) turn = {.role = RowRole::Spring, .spring = *definition.angular_spring};
  rules.turn.add(turn);
  return rules;
}

void validate(const WeldDefinition& definition) {
  const JointCheck check("weld joint");
  check.finite("anchor_a", definition.anchor_a);
  check.finite("anchor_b", definition.anchor_b);
  check.finite("reference_angle", definition.reference_angle);
  check.spring("linear_spring", definition.linear_spring);
  check.spring("angular_spring", definition.angular_spring);
}

template struct WeldRows<float>;
template struct WeldRows<double>;
template struct WeldRows<Dual>;
template struct SoftWeldRows<float>;
template struct SoftWeldRows<double>;
template struct SoftWeldRows<Dual>;

}  // namespace plumb
