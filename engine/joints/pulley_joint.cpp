#include "engine/joints/pulley_joint.h"

#include "engine/joints/joint_check.h"
#include "engine/math/dual.h"

namespace plumb {

template <class Real>
PulleyRows<Real>::PulleyRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
    : anchor_a((definition.anchor_a - centre_a).as<Real>()),
      anchor_b((definition.anchor_b - centre_b).as<Real>()),
      ground_a(definition.ground_a),
      ground_b(definition.ground_b),
      ratio(static_cast<Real>(definition.ratio)) {}

JointRules rules_of(const PulleyDefinition& definition) {
  JointRules rules;
  rules.axial[0].add({.origin = definition.length.value_or(0)});
  return rules;
}

void validate(const PulleyDefinition& definition) {
  const JointCheck check("pulley joint");
  check.finite("ground_a", definition.ground_a);
  check.finite("ground_b", definition.ground_b);
  check.finite("anchor_a", definition.anchor_a);
  check.finite("anchor_b", definition.anchor_b);
  check.positive("ratio", definition.ratio);
  if (definition.length) check.positive("length", *definition.length);
}

template struct PulleyRows<float>;
template struct PulleyRows<double>;
template struct PulleyRows<Dual>;

}  // namespace plumb
