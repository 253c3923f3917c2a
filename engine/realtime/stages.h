#pragma once

#include "engine/driver/accuracy.h"
#include "engine/driver/plan.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Stages of a Realtime step, in the order in which they run. A plan lists them all.
enum class RealtimeStage {
  BroadPhase,    ///< finds shapes near each other
  NarrowPhase,   ///< computes contact points and normals
  Forces,        ///< accelerations by force laws
  Kick,          ///< v += a h
  Restitution,   ///< impacts, each at its own time
  ContactHold,   ///< impulses that keep separations from falling below zero
  JointHold,     ///< impulses that keep joints closed where the bodies arrive
  Drift,         ///< x += v h
  Turn,          ///< angle += w h, and all angular arithmetic
  PushOut,       ///< overlaps, by moving bodies apart
  JointRelax,    ///< J v = 0
  ContactRelax,  ///< v_n >= 0
  Friction,      ///< impulses in the Coulomb cone; their time is part of the contact stages'
  Check,         ///< that every state is finite
  Watch,         ///< that the step kept what is promised
};
inline constexpr int kRealtimeStages = static_cast<int>(RealtimeStage::Watch) + 1;

/// Derives what a step needs for `scene`, and why. With `every_stage` all stages run, needed or not.
Plan plan_realtime(const Scene& scene, const Realtime& accuracy, bool every_stage);

inline bool is_active(const Plan& plan, RealtimeStage stage) {
  return plan.stages[static_cast<std::size_t>(stage)].active;
}

}  // namespace plumb
