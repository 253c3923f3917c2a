#pragma once

#include <cmath>

#include "engine/world/state/constants.h"
#include "engine/world/world_data.h"

/// Sleeping: an island (bodies connected by contacts and joints) falls asleep when all its bodies have been
/// at rest for long enough. It wakes as a whole.
namespace plumb {

/// Returns true if a body of this motion counts as at rest, so that its sleep timer runs: up to the speed
/// `thresholds.sleep`, by default 0.05 extents a second. `extent` is the farthest distance of its shapes from
/// the centre of mass, m; a body without shapes uses its radius of gyration. A body may be moved without a
/// velocity, for example when a joint is closed: then its displacement in `dt`, s, counts as motion (with 0
/// only its velocity does).
template <class Real>
bool is_still(const WorldData<Real>& w, const BodyRecord<Real>& record, const SolverBody<Real>& motion,
              Real extent, Real dt) {
  if (record.type == BodyType::Kinematic && (motion.velocity != Vec2<Real>{} || motion.angular_velocity != 0))
    return false;
  if (extent == 0 && motion.inverse_inertia > 0)
    extent = std::sqrt(motion.inverse_mass / motion.inverse_inertia);
  const double set = w.settings.thresholds.sleep;
  const Real max_speed = set >= 0 ? static_cast<Real>(set) : Real(tuning::kSleepSpeed) * extent;
  const auto speed = [extent](Vec2<Real> linear, Real angular) {
    return std::sqrt(length_squared(linear)) + std::abs(angular) * extent;
  };
  return record.may_sleep && speed(motion.velocity, motion.angular_velocity) <= max_speed &&
         (dt == 0 || speed(motion.delta_position, motion.delta_angle) <= max_speed * dt);
}

/// Wakes a sleeping body and everything connected to it through dynamic bodies; a kinematic body wakes alone.
/// Does nothing for awake and static bodies. If memory runs out, throws and leaves all of them asleep.
template <class Real>
void wake_body(WorldData<Real>& w, int body);

/// Wakes the body, and all bodies that touch it or are joined to it.
template <class Real>
void wake_neighbours(WorldData<Real>& w, int body);

/// Puts islands to sleep whose bodies are all at rest. Islands are searched only if some body could sleep.
template <class Real>
void sleep_islands(WorldData<Real>& w);

/// Puts the body's whole island to sleep at once.
template <class Real>
void put_to_sleep(WorldData<Real>& w, int body);

/// Puts one body to sleep. The caller deactivates its contacts and joints.
template <class Real>
void fall_asleep(WorldData<Real>& w, int body);

/// Only adds a body to the list of awake bodies, or removes it.
template <class Real>
void add_awake(WorldData<Real>& w, int body);
template <class Real>
void remove_awake(WorldData<Real>& w, int body);

}  // namespace plumb
