#include "engine/joints/gear_joint.h"

#include "engine/joints/joint_check.h"
#include "engine/math/dual.h"

namespace plumb {

template <class Real>
GearRows<Real>::GearRows(const Definition& definition, Vec2d, Vec2d)
    : ratio(static_cast<Real>(definition.ratio)),
      exact_ratio(definition.ratio),
      reference(definition.phase) {}

JointRules rules_of(const GearDefinition& definition) {
  static_cast<void>(definition);
  JointRules rules;
  rules.axial[0].add({});
  return rules;
}

void validate(const GearDefinition& definition) {
  const JointCheck check("gear joint");
  check.not_zero("ratio", definition.ratio, 1e-9);
  check.finite("phase", definition.phase);
}

template struct GearRows<float>;
template struct GearRows<double>;
template struct GearRows<Dual>;

}  // namespace plumb
