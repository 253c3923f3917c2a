#include "engine/joints/ratchet_joint.h"

#include "engine/joints/joint_check.h"

namespace plumb {

template <class Real>
RatchetRows<Real>::RatchetRows(const Definition& definition, Vec2d, Vec2d)
    : tooth(definition.tooth), reference(definition.phase) {}

JointRules rules_of(const RatchetDefinition& definition) {
  JointRules rules;
  rules.turn.add({.role = RowRole::Limit, .sign = definition.tooth > 0 ? 1.0 : -1.0});
  return rules;
}

void validate(const RatchetDefinition& definition) {
  const JointCheck check("ratchet joint");
  check.not_zero("tooth", definition.tooth, 1e-6);
  check.finite("phase", definition.phase);
}

template struct RatchetRows<float>;
template struct RatchetRows<double>;

}  // namespace plumb
