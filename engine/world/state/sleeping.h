#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/state/constants.h"
#include "engine/world/world_data.h"

/// Sleeping: an island (bodies connected by contacts and joints) falls asleep when all its bodies have been
/// at rest for long enough. It wakes as a whole.
namespace plumb {

/// Returns the length, m, by which rotations of a body count as motion: `extent`, the farthest distance of
/// its shapes from the centre of mass; without shapes its radius of gyration.
template <class Real>
Real sleep_extent(const SolverBody<Real>& motion, Real extent) {
  return extent == 0 && motion.inverse_inertia > 0 ? std::sqrt(motion.inverse_mass / motion.inverse_inertia)
                                                   : extent;
}

/// Returns true if a body of this motion is slow enough to be at rest: up to the speed `thresholds.sleep`, by
/// default 0.05 extents a second. A body may be moved without a velocity, for example when a joint is closed:
/// then its displacement in `dt`, s, counts as motion (with 0 only its velocity does).
template <class Real>
bool is_still(const WorldData<Real>& w, const BodyRecord<Real>& record, const SolverBody<Real>& motion,
              Real extent, Real dt) {
  if (record.type == BodyType::Kinematic && (motion.velocity != Vec2<Real>{} || motion.angular_velocity != 0))
    return false;
  extent = sleep_extent(motion, extent);
  const double set = w.settings.thresholds.sleep;
  const Real max_speed = set >= 0 ? static_cast<Real>(set) : Real(tuning::kSleepSpeed) * extent;
  const auto speed = [extent](Vec2<Real> linear, Real angular) {
    return std::sqrt(length_squared(linear)) + std::abs(angular) * extent;
  };
  return record.may_sleep && speed(motion.velocity, motion.angular_velocity) <= max_speed &&
         (dt == 0 || speed(motion.delta_position, motion.delta_angle) <= max_speed * dt);
}

/// Returns the acceleration, m/s^2, that gravity would give a body by itself: 0 along locked axes.
template <class Real>
Vec2d gravity_on(const WorldData<Real>& w, const BodyRecord<Real>& record) {
  if (record.type != BodyType::Dynamic) return {};
  const Vec2d gravity = w.settings.gravity;
  const double scale =
      record.uncommon == kNone ? 1 : static_cast<double>(w.body_extras[record.uncommon].gravity_scale);
  return {record.lock_x ? 0 : scale * gravity.x, record.lock_y ? 0 : scale * gravity.y};
}

/// Returns the displacement, m, up to which a slow body is at rest within kSleepTime (rotations count by
/// `extent`): see kRestDisplacement and kRestFall. A speed that the user has set lowers it to what passes at
/// that speed; as much as it is above the default speed, it raises the limit.
template <class Real>
double rest_limit(const WorldData<Real>& w, Vec2d gravity, double extent) {
  constexpr double kTime = tuning::kSleepTime;
  double limit = tuning::kRestDisplacement * extent;
  if (gravity != Vec2d{}) limit = std::min(limit, tuning::kRestFall / 2 * kTime * kTime * length(gravity));
  const double set = w.settings.thresholds.sleep;
  if (set >= 0)
    limit = std::min(limit, set * kTime) + kTime * std::max(0.0, set - tuning::kSleepSpeed * extent);
  return std::max(
      limit, tuning::kRestRoundings * static_cast<double>(std::numeric_limits<Real>::epsilon()) * extent);
}

/// Returns the sleep timer, s, of a body that is_still after a step of `dt`, s. The timer measures rest, not
/// slowness: it restarts if the body has moved farther than `rest_limit` since it started or, once it exceeds
/// kSleepTime, within the present period of that length. Displacements are signed, so that jitter cancels. A
/// body that nothing holds and no `load` pushes is not at rest under gravity.
template <class Real>
[[gnu::noinline]] Real time_at_rest(const WorldData<Real>& w, int body, Real extent, Real dt,
                                    const Load<Real>* load, RestDisplacement& rest) {
  const BodyRecord<Real>& record = w.bodies[body];
  const SolverBody<Real>& motion = w.motion[body];
  const Real before = record.sleep_time;
  const Vec2d gravity = gravity_on(w, record);
  if (record.constraints == 0 && gravity != Vec2d{} && (load == nullptr || load->force == Vec2<Real>{}))
    return 0;
  if (before == 0) rest = {};
  rest.translation += motion.delta_position.template as<float>();
  rest.rotation += static_cast<float>(motion.delta_angle);
  const double size = static_cast<double>(sleep_extent(motion, extent));
  const double moved = length(rest.translation.as<double>()) + size * std::abs(double(rest.rotation));
  if (moved > rest_limit(w, gravity, size)) return 0;
  constexpr Real kTime = tuning::kSleepTime;
  const Real time = before + dt;
  // A period is over at kSleepTime, and then whenever the timer, set back by one period, reaches twice that.
  if (time >= kTime && (before < kTime || time >= 2 * kTime)) rest = {};
  return time >= 2 * kTime ? std::max(kTime, time - kTime) : time;
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
