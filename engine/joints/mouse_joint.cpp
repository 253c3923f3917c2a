#include "engine/joints/mouse_joint.h"

#include "engine/joints/joint_check.h"
#include "engine/math/dual.h"

namespace plumb {

template <class Real>
MouseRows<Real>::MouseRows(const Definition& definition, Vec2d, Vec2d centre_b)
    : anchor_b((definition.anchor_b - centre_b).as<Real>()),
      ground_a(definition.target),
      ground_b(definition.target) {}

JointRules rules_of(const MouseDefinition& definition) {
  JointRules rules;
  rules.point = {.role = RowRole::Spring, .spring = definition.spring, .max_force = definition.max_force};
  return rules;
}

void validate(const MouseDefinition& definition) {
  const JointCheck check("mouse joint");
  check.finite("anchor_b", definition.anchor_b);
  check.finite("target", definition.target);
  check.spring("spring", definition.spring);
  check.not_negative("max_force", definition.max_force);
}

template struct MouseRows<float>;
template struct MouseRows<double>;
template struct MouseRows<Dual>;

}  // namespace plumb
