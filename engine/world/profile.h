#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace plumb {

/// Stages of a step, in the order in which they run.
enum class WorldStage : std::uint8_t {
  BroadPhase,   ///< finds shapes whose fat AABBs started to overlap
  NarrowPhase,  ///< updates contact manifolds
  Solver,       ///< solves joints and contacts, and integrates the motion
  Finalize,     ///< moves the bodies and updates their AABBs
  Continuous,   ///< stops fast bodies at their first time of impact
  Events,       ///< reports impacts, breaks joints, updates sensors
  Sleep,        ///< puts islands at rest to sleep
};
inline constexpr std::size_t kWorldStages = 7;

/// Names in tables, by WorldStage.
inline constexpr const char* kWorldStageNames[] = {"broad_phase", "narrow_phase", "solver", "finalize",
                                                   "continuous",  "events",       "sleep"};

/// Wall time of each stage since profiling was switched on, ns.
struct WorldProfile {
  std::array<double, kWorldStages> nanoseconds{};
  std::int64_t steps = 0;

  double of(WorldStage stage) const { return nanoseconds[static_cast<std::size_t>(stage)]; }
};

}  // namespace plumb
