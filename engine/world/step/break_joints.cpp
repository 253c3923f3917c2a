#include "engine/world/events.h"
#include "engine/world/state/bodies.h"
#include "engine/world/step/step.h"

namespace plumb {

template <class Real>
void break_joints(WorldData<Real>& w, double h) {
  const Real rate = static_cast<Real>(1 / h);
  for (std::size_t i = 0; i < w.breakable.size();) {
    const int joint = w.breakable[i];
    const JointRecord& record = w.joints[joint];
    const bool breaks =
        record.active &&
        ((record.break_force > 0 && double(w.joint_set.force(record.slot, rate)) > record.break_force) ||
         (record.break_torque > 0 && double(w.joint_set.torque(record.slot, rate)) > record.break_torque));
    if (!breaks) {
      ++i;
      continue;
    }
    w.log().broken.push_back({{static_cast<std::uint32_t>(joint), w.joints.generation(joint)}});
    remove_joint(w, joint);
  }
}

template void break_joints(WorldData<float>&, double);
template void break_joints(WorldData<double>&, double);

}  // namespace plumb
