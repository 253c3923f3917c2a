#include "engine/world/events.h"
#include "engine/world/state/bodies.h"
#include "engine/world/step/step.h"

namespace plumb {

template <class Real>
void break_joints(WorldData<Real>& w) {
  const auto exceeds = [](double load, double limit) { return limit > 0 && load > limit; };
  for (std::size_t i = 0; i < w.load_limited_joints.size();) {
    const int joint = w.load_limited_joints[i];
    const JointRecord& record = w.joints[joint];
    const JointId id{static_cast<std::uint32_t>(joint), w.joints.generation(joint)};
    // Joints of sleeping bodies keep their loads, which are not reported again.
    const bool bears = record.active && (w.bodies[record.body_a].awake || w.bodies[record.body_b].awake);
    const double force = record.active ? static_cast<double>(w.joint_set.force(record.slot)) : 0;
    const double torque = record.active ? static_cast<double>(w.joint_set.torque(record.slot)) : 0;
    if (bears && (exceeds(force, record.report_force) || exceeds(torque, record.report_torque)))
      w.event_buffer().loaded.push_back({id, force, torque});
    if (!exceeds(force, record.break_force) && !exceeds(torque, record.break_torque)) {
      ++i;
      continue;
    }
    w.event_buffer().broken.push_back({id});
    remove_joint(w, joint);
  }
}

template void break_joints(WorldData<float>&);
template void break_joints(WorldData<double>&);

}  // namespace plumb
