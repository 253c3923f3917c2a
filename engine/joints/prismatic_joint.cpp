#include "engine/joints/prismatic_joint.h"

#include "engine/joints/joint_check.h"
#include "engine/math/dual.h"

namespace plumb {

template <class Real>
PrismaticRows<Real>::PrismaticRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
    : anchor_a((definition.anchor_a - centre_a).as<Real>()),
      anchor_b((definition.anchor_b - centre_b).as<Real>()),
      axis(unit(definition.axis).template as<Real>()),
      reference(definition.reference_angle) {}

JointRules rules_of(const PrismaticDefinition& definition) {
  JointRules rules;
  RowRules& along = rules.axial[0];
  along.add_spring(definition.spring, definition.target_translation);
  along.add_motor(definition.motor);
  along.add_limits(definition.limits);
  return rules;
}

void validate(const PrismaticDefinition& definition) {
  const JointCheck check("prismatic joint");
  check.finite("anchor_a", definition.anchor_a);
  check.finite("anchor_b", definition.anchor_b);
  check.axis("axis", definition.axis);
  check.finite("reference_angle", definition.reference_angle);
  check.range("limits", definition.limits);
  check.motor("motor", definition.motor);
  check.spring("spring", definition.spring);
  check.finite("target_translation", definition.target_translation);
}

template struct PrismaticRows<float>;
template struct PrismaticRows<double>;
template struct PrismaticRows<Dual>;

}  // namespace plumb
