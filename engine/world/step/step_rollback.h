#pragma once

#include "engine/core/capacity.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Keeps the awake bodies' motion during a step that calls user code after bodies have moved: the pre-solve
/// hook, for impacts that only continuous collision finds. Keeps none in worlds without a hook.
template <class Real>
void keep_motion(WorldData<Real>& w) {
  if (!w.pre_solve || !w.settings.continuous) return;
  std::vector<BodyMotion<Real>>& before = w.scratch.motion_before_step;
  resize_with_growth(before, static_cast<int>(w.awake.size()));
  for (std::size_t i = 0; i < before.size(); ++i) {
    const int body = w.awake[i];
    const BodyRecord<Real>& record = w.bodies[body];
    before[i] = {body,
                 w.motion[body],
                 w.rotation[body],
                 w.position[body],
                 w.position_compensation.get(body),
                 record.angle,
                 record.sleep_time,
                 w.rest_displacements.get(body),
                 w.loads.get(body)};
  }
}

/// Forgets the motion that an earlier step has kept.
template <class Real>
void forget_motion(WorldData<Real>& w) {
  w.scratch.motion_before_step.clear();
}

/// Moves the bodies back, with the velocities and loads that they had, if this step has kept them.
template <class Real>
void restore_motion(WorldData<Real>& w) {
  for (const BodyMotion<Real>& before : w.scratch.motion_before_step) {
    const int body = before.body;
    BodyRecord<Real>& record = w.bodies[body];
    w.motion[body] = before.motion, w.rotation[body] = before.rotation;
    w.position[body] = before.position;
    if (w.position_compensation.used()) w.position_compensation.data()[body] = before.compensation;
    record.angle = before.angle, record.sleep_time = before.sleep_time;
    if (w.rest_displacements.used()) w.rest_displacements.data()[body] = before.rest_displacement;
    if (w.loads.used()) w.loads.data()[body] = before.load;
  }
}

}  // namespace plumb
