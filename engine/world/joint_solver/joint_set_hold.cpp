#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {

template <class Real>
bool JointSet<Real>::is_hinge(int joint) const {
  return parts_->slot(joint).form == kHinge;
}

template <class Real>
HeldHinge<Real> JointSet<Real>::hold(int joint) {
  const JointSlot& slot = parts_->slot(joint);
  const auto& definition = std::get<RevoluteDefinition>(slot.definition);
  auto& hinge = std::get<kHinge>(parts_->store)[slot.colour][slot.index];
  hinge.held = true;
  return {definition.anchor_a - slot.centre_a, definition.anchor_b - slot.centre_b, &hinge.point.impulse};
}

template <class Real>
void JointSet<Real>::let_go() {
  for (auto& list : std::get<kHinge>(parts_->store))
    for (auto& hinge : list) hinge.held = false;
}

template bool JointSet<float>::is_hinge(int) const;
template bool JointSet<double>::is_hinge(int) const;
template HeldHinge<float> JointSet<float>::hold(int);
template HeldHinge<double> JointSet<double>::hold(int);
template void JointSet<float>::let_go();
template void JointSet<double>::let_go();

}  // namespace plumb
