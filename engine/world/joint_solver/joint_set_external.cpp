#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {

template <class Real>
bool JointSet<Real>::is_hinge(int joint) const {
  return parts_->slot(joint).form == kHinge;
}

template <class Real>
ExternalHinge<Real> JointSet<Real>::set_external(int joint) {
  const JointSlot& slot = parts_->slot(joint);
  const auto& definition = std::get<RevoluteDefinition>(slot.definition);
  auto& hinge = std::get<kHinge>(parts_->store)[slot.colour][slot.index];
  hinge.external = true;
  return {definition.anchor_a - slot.centre_a,
          definition.anchor_b - slot.centre_b,
          {&hinge.point.impulse, &hinge.mean_force}};
}

template <class Real>
void JointSet<Real>::clear_external() {
  for (auto& list : std::get<kHinge>(parts_->store))
    for (auto& hinge : list) hinge.external = false;
}

template bool JointSet<float>::is_hinge(int) const;
template bool JointSet<double>::is_hinge(int) const;
template ExternalHinge<float> JointSet<float>::set_external(int);
template ExternalHinge<double> JointSet<double>::set_external(int);
template void JointSet<float>::clear_external();
template void JointSet<double>::clear_external();

}  // namespace plumb
