#pragma once

#include "engine/core/capacity.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Keeps the awake bodies' motion during a step that calls user code after bodies have moved: the pre-solve
/// hook, for impacts that only continuous collision finds. Does nothing in worlds without a hook.
template <class Real>
class StepRollback {
 public:
  explicit StepRollback(WorldData<Real>& w) : w_(w) {
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
    active_ = true;
  }

  /// Moves the bodies back, with the velocities and loads that they had.
  void restore() {
    if (!active_) return;
    for (const BodyMotion<Real>& before : w_.scratch.motion_before_step) {
      const int body = before.body;
      BodyRecord<Real>& record = w_.bodies[body];
      w_.motion[body] = before.motion, w_.rotation[body] = before.rotation;
      w_.position[body] = before.position;
      if (w_.position_compensation.used()) w_.position_compensation.data()[body] = before.compensation;
      record.angle = before.angle, record.sleep_time = before.sleep_time;
      if (w_.rest_displacements.used()) w_.rest_displacements.data()[body] = before.rest_displacement;
      if (w_.loads.used()) w_.loads.data()[body] = before.load;
    }
  }

 private:
  WorldData<Real>& w_;
  bool active_ = false;
};

}  // namespace plumb
