#include "engine/world/solvers/struck_bodies.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace plumb {
namespace {

// Smallest sudden change of velocity that is an impact, in steps of gravity, and in extents of the body a
// second (which counts without gravity). What falls off an edge changes by the gravity of a substep, what a
// game moves once a step by the acceleration of a step. At 2 steps, a pyramid of 10 rows that is dropped by
// 0.5 m leaves the floor by 0.34 m, at 1 by 15 mm (at a half by 0.1 mm; but it is pressed together by 11 cm
// instead of 8).
constexpr double kStruckSteps = 1, kStruckSpeed = 0.05;

// Number of bodies in one task of a thread: some microseconds of work.
constexpr int kBodiesPerTask = 512;

// Returns the magnitude of a body's change of velocity in the substep that has just ended, m/s.
template <class Real>
Real change_of(const SolverBody<Real>& motion, const VelocityIncrement<Real>& increment, Real extent) {
  const Vec2<Real> velocity = motion.velocity - increment.velocity_before + increment.velocity;
  const Real spin = extent * (motion.angular_velocity - increment.spin_before + increment.spin);
  return std::sqrt(length_squared(velocity) + spin * spin);
}

}  // namespace

template <class Real>
bool find_struck_bodies(WorldData<Real>& w, double dt) {
  const Real by_gravity =
      static_cast<Real>(kStruckSteps * dt * std::sqrt(length_squared(w.settings.gravity)));
  const std::vector<VelocityIncrement<Real>>& increments = w.scratch.velocity_increments;
  std::atomic<bool> any = false;
  w.scheduler.ranges(static_cast<int>(increments.size()), kBodiesPerTask, [&](int first, int last) {
    bool found = false;
    for (int i = first; i < last; ++i) {
      const VelocityIncrement<Real>& increment = increments[i];
      const int body = increment.body;
      const Real extent = w.extents[body];
      SubstepChange<Real>& change = w.substep_changes[body];
      const Real speed = increment.in_tree ? Real(0) : change_of(w.motion[body], increment, extent);
      change.struck = std::abs(speed - change.speed) > std::max(by_gravity, Real(kStruckSpeed) * extent) &&
                      w.bodies[body].first_joint == kNone;
      change.speed = speed;
      found |= change.struck;
    }
    if (found) any.store(true, std::memory_order_relaxed);
  });
  return any;
}

template <class Real>
bool any_struck_body(const WorldData<Real>& w) {
  const std::vector<VelocityIncrement<Real>>& increments = w.scratch.velocity_increments;
  return std::any_of(increments.begin(), increments.end(),
                     [&](const auto& increment) { return w.substep_changes[increment.body].struck; });
}

#define PLUMB_FOR(Real)                                       \
  template bool find_struck_bodies(WorldData<Real>&, double); \
  template bool any_struck_body(const WorldData<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
