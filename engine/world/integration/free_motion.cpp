#include "engine/world/integration/free_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/capacity.h"
#include "engine/math/small_rotation.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/prefetch_awake_bodies.h"

namespace plumb {
namespace {

// Returns exp(-x) for x >= 0 without a library: exp(-x / 2^k)^(2^k), where x / 2^k is small enough for the
// series.
double decay(double x) {
  int halvings = 0;
  for (; x > 0.125; x *= 0.5) ++halvings;
  // 1 - x + x^2/2 - ... to x^9/9!: below rounding for x <= 1/8.
  double sum = 1;
  for (int n = 9; n >= 1; --n) sum = 1 - x / n * sum;
  for (; halvings > 0; --halvings) sum *= sum;
  return sum;
}

// Means over a time t, as fractions. With damping c and x = c t, phi_1 = (1 - e^-x) / x is that of a decaying
// velocity, and phi_2 = (1 - phi_1) / x that of a velocity that grows from 0. Under a constant acceleration
// a, v' = e^-x v + phi_1 t a, and the displacement is t (phi_1 v + phi_2 t a).
struct DampedMeans {
  double first, second;
};

DampedMeans damped_means(double x) {
  if (x > 0.125) {
    const double first = (1 - decay(x)) / x;
    return {first, (1 - first) / x};
  }
  // 1/2! - x/3! + x^2/4! - ... to x^9/11!: below rounding.
  double second = 0;
  for (int n = 11; n >= 2; --n) second = (1 - x * second) / n;
  return {1 - x * second, second};
}

// Returns the change of a body's velocities by gravity and loads alone, with the factors of its damping.
template <class Real>
VelocityIncrement<Real> undamped_increment_of(const WorldData<Real>& w, int body, double time) {
  const BodyRecord<Real>& record = w.bodies[body];
  const SolverBody<Real>& motion = w.motion[body];
  const Real t = static_cast<Real>(time);
  VelocityIncrement<Real> increment;
  increment.body = body;
  if (record.type != BodyType::Dynamic) return increment;
  const Vec2<Real> gravity = w.settings.gravity.template as<Real>();
  const BodyExtras<Real>& own = w.extras_of(body);
  const Load<Real> load = w.loads.get(body);
  increment.velocity = t * (own.gravity_scale * gravity + motion.inverse_mass * load.force);
  increment.spin = t * motion.inverse_inertia * load.torque;
  if (own.linear_damping > 0)
    increment.damping_factor = static_cast<Real>(decay(time * double(own.linear_damping)));
  if (own.angular_damping > 0)
    increment.spin_damping_factor = static_cast<Real>(decay(time * double(own.angular_damping)));
  increment.locked_x = record.lock_x, increment.locked_y = record.lock_y;
  return increment;
}

}  // namespace

template <class Real>
VelocityIncrement<Real> velocity_increment_of(const WorldData<Real>& w, int body, double time) {
  VelocityIncrement<Real> increment = undamped_increment_of(w, body, time);
  const auto first_mean = [time](Real damping) {
    return static_cast<Real>(damped_means(time * double(damping)).first);
  };
  if (increment.damping_factor != 1)
    increment.velocity = first_mean(w.extras_of(body).linear_damping) * increment.velocity;
  if (increment.spin_damping_factor != 1) increment.spin *= first_mean(w.extras_of(body).angular_damping);
  return increment;
}

namespace {

template <class Real>
void apply(const VelocityIncrement<Real>& increment, SolverBody<Real>& motion) {
  motion.velocity = increment.damping_factor * motion.velocity + increment.velocity;
  motion.angular_velocity = increment.spin_damping_factor * motion.angular_velocity + increment.spin;
  if (increment.locked_x) motion.velocity.x = 0;
  if (increment.locked_y) motion.velocity.y = 0;
}

// Returns the weight of the velocity before the increment in the mean velocity that moves a body.
constexpr double old_velocity_weight(Integrator integrator) {
  return integrator == Integrator::VelocityVerlet ? 0.5 : integrator == Integrator::ExplicitEuler ? 1 : 0;
}

// Advances a velocity under a constant acceleration and damping. `gain` is the change by the acceleration
// alone, `keep` the fraction of a velocity that damping leaves, and `x` is c times the time. Returns the
// displacement.
template <class Value, class Real>
Value integrate_damped(Value& velocity, Value gain, Real damping_factor, double x, Real time) {
  const Value before = velocity;
  if (damping_factor == 1) {
    velocity = before + gain;
    return (Real(0.5) * time) * (before + velocity);
  }
  const DampedMeans means = damped_means(x);
  const Real first = static_cast<Real>(means.first), second = static_cast<Real>(means.second);
  velocity = damping_factor * before + first * gain;
  return time * (first * before + second * gain);
}

// Moves a body in free flight through the step. Exact for constant acceleration.
template <class Real>
void integrate_free_body(WorldData<Real>& w, int body, double dt) {
  const VelocityIncrement<Real> increment = undamped_increment_of(w, body, dt);
  const BodyExtras<Real>& own = w.extras_of(body);
  SolverBody<Real>& motion = w.motion[body];
  const Real t = static_cast<Real>(dt);
  motion.delta_position = integrate_damped(motion.velocity, increment.velocity, increment.damping_factor,
                                           dt * double(own.linear_damping), t);
  if (increment.locked_x) motion.delta_position.x = motion.velocity.x = 0;
  if (increment.locked_y) motion.delta_position.y = motion.velocity.y = 0;
  motion.delta_angle = integrate_damped(motion.angular_velocity, increment.spin,
                                        increment.spin_damping_factor, dt * double(own.angular_damping), t);
  if (motion.delta_angle != 0) w.rotation[body] = rotated_by(w.rotation[body], motion.delta_angle);
}

// Returns true if a body is in free flight under gravity alone, without an applied load.
template <class Real>
bool has_gravity_only(const BodyRecord<Real>& record) {
  return record.type == BodyType::Dynamic && record.uncommon == kNone && !record.lock_x && !record.lock_y;
}

// Moves a body in free flight under gravity alone, which adds `gain` to its velocity.
template <class Real>
void integrate_free_fall(WorldData<Real>& w, int body, Vec2<Real> gain, Real dt) {
  SolverBody<Real>& motion = w.motion[body];
  const Vec2<Real> before = motion.velocity;
  motion.velocity += gain;
  motion.delta_position = (Real(0.5) * dt) * (before + motion.velocity);
  motion.delta_angle = Real(0.5) * dt * (motion.angular_velocity + motion.angular_velocity);
  if (motion.delta_angle != 0) w.rotation[body] = rotated_by(w.rotation[body], motion.delta_angle);
}

// Bodies per block of a shared loop: about 5 us of work.
constexpr int kBodiesPerBlock = 256;

template <class Real, class Visit>
void for_each_increment(WorldData<Real>& w, const Visit& visit) {
  std::vector<VelocityIncrement<Real>>& increments = w.scratch.solver.velocity_increments;
  w.scheduler.ranges(static_cast<int>(increments.size()), kBodiesPerBlock, [&](int first, int last) {
    const Visit own = visit;  // a local copy, which no pointer can change
    VelocityIncrement<Real>* const list = increments.data();
    for (int i = first; i < last; ++i) own(list[i]);
  });
}

// Returns true if a body moves by substeps instead of by one step in free flight.
template <class Real>
bool moves_by_substeps(const BodyRecord<Real>& record, Integrator integrator) {
  return integrator != Integrator::VelocityVerlet || record.constraints != 0;
}

// Counts in each block the bodies that move by substeps, and reserves memory for their increments. Returns
// the index of the first increment of each block.
template <class Real>
const int* reserve_increments(WorldData<Real>& w, int blocks, Integrator integrator) {
  std::vector<int>& firsts = w.scratch.block_firsts;
  resize_with_growth(firsts, blocks + 1);
  firsts[0] = 0;
  const int count = static_cast<int>(w.awake.size());
  w.scheduler.blocks(blocks, [&](int block) {
    int found = 0;
    for (int i = block * kBodiesPerBlock; i < std::min(count, (block + 1) * kBodiesPerBlock); ++i)
      found += static_cast<int>(moves_by_substeps(w.bodies[w.awake[i]], integrator));
    firsts[block + 1] = found;
  });
  for (int block = 0; block < blocks; ++block) firsts[block + 1] += firsts[block];
  resize_with_growth(w.scratch.solver.velocity_increments, firsts[blocks]),
      resize_with_growth(w.scratch.solver.start_velocities, firsts[blocks]);
  return firsts.data();
}

}  // namespace

template <class Real>
void prepare_integration(WorldData<Real>& w, double h, int substeps, Integrator integrator) {
  std::vector<VelocityIncrement<Real>>& increments = w.scratch.solver.velocity_increments;
  increments.clear(), w.scratch.solver.start_velocities.clear();
  const double dt = h * substeps;
  const Vec2<Real> gain = static_cast<Real>(dt) * w.settings.gravity.template as<Real>();
  const bool loaded = w.loads.used(), articulated = !w.scratch.islands.trees.empty();
  const PrefetchAwakeBodies<Real> ahead(w);
  const int count = static_cast<int>(w.awake.size());
  // Moves a free body, or stores the increment of another one.
  const auto prepare = [&w, &ahead, h, dt, gain, loaded, articulated, integrator](int index,
                                                                                  const auto& add) {
    ahead.prefetch_motion(index);
    const int body = w.awake[index];
    const BodyRecord<Real>& record = w.bodies[body];
    if (!moves_by_substeps(record, integrator)) {
      if (!loaded && has_gravity_only(record)) {
        integrate_free_fall(w, body, gain, static_cast<Real>(dt));
      } else {
        integrate_free_body(w, body, dt);
      }
      return;
    }
    SolverBody<Real>& motion = w.motion[body];
    VelocityIncrement<Real> increment = velocity_increment_of(w, body, h);
    // The displacement of the last step, for `ramp_kinematic_velocities`.
    increment.velocity_before = motion.delta_position, increment.spin_before = motion.delta_angle;
    motion.delta_position = {}, motion.delta_angle = 0;
    increment.in_tree = articulated && w.scratch.islands.trees.is_link[body];
    add(increment, BodyVelocity<Real>{motion.velocity, motion.angular_velocity});
  };
  if (!w.scheduler.shares()) {
    for (int index = 0; index < count; ++index) {
      prepare(index, [&](const VelocityIncrement<Real>& increment, const BodyVelocity<Real>& start) {
        increments.push_back(increment), w.scratch.solver.start_velocities.push_back(start);
      });
    }
    return;
  }
  const int blocks = (count + kBodiesPerBlock - 1) / kBodiesPerBlock;
  const int* const firsts = reserve_increments(w, blocks, integrator);
  w.scheduler.blocks(blocks, [&](int block) {
    int next = firsts[block];
    for (int index = block * kBodiesPerBlock; index < std::min(count, (block + 1) * kBodiesPerBlock);
         ++index) {
      prepare(index, [&](const VelocityIncrement<Real>& increment, const BodyVelocity<Real>& start) {
        increments[next] = increment, w.scratch.solver.start_velocities[next] = start;
        ++next;
      });
    }
  });
}

namespace {

// Returns the displacement of a body that moves by equal velocities in the substeps, as their sum rounds it.
template <class Value, class Real>
Value displacement_by(Value velocity, Real h, int substeps) {
  Value sum{};
  for (int i = 0; i < substeps; ++i) sum += h * velocity;
  return sum;
}

// Returns the fraction of a change of `size` that is at most `limit`.
template <class Real>
Real fraction_within(Real size, Real limit) {
  return size > limit ? limit / size : 1;
}

}  // namespace

template <class Real>
bool ramp_kinematic_velocities(WorldData<Real>& w, double h, int substeps) {
  if (!enabled(Switch::KinematicRamps)) return false;
  const double last_dt = w.last_h * w.last_substeps;
  const Real most = static_cast<Real>(h * substeps * std::sqrt(length_squared(w.settings.gravity)));
  if (substeps == 1 || !(most > 0)) return false;
  const Real last_h = static_cast<Real>(w.last_h),
             per_time = last_dt > 0 ? static_cast<Real>(1 / last_dt) : 0,
             per_substep = Real(1) / static_cast<Real>(substeps);
  // Relative rounding of a displacement that is a sum over the substeps, or a single product in free motion.
  const Real rounding = static_cast<Real>(w.last_substeps + 1) * std::numeric_limits<Real>::epsilon();
  // Returns the change from the mean velocity of the last step; none if its displacement is that of `now`.
  const auto change_to = [&](Real now, Real last_displacement) {
    if (per_time == 0) return now;
    const Real expected = displacement_by(now, last_h, w.last_substeps),
               missed = expected - last_displacement;
    return std::abs(missed) <= rounding * std::abs(expected) ? Real(0) : per_time * missed;
  };
  bool any = false;
  for (VelocityIncrement<Real>& increment : w.scratch.solver.velocity_increments) {
    SolverBody<Real>& motion = w.motion[increment.body];
    if (is_dynamic(motion) || w.bodies[increment.body].type != BodyType::Kinematic) continue;
    Vec2<Real> change{change_to(motion.velocity.x, increment.velocity_before.x),
                      change_to(motion.velocity.y, increment.velocity_before.y)};
    Real spin_change = change_to(motion.angular_velocity, increment.spin_before);
    if (change == Vec2<Real>{} && spin_change == 0) continue;
    change = fraction_within(std::sqrt(length_squared(change)), most) * change;
    spin_change *= fraction_within(std::abs(spin_change) * w.extents[increment.body], most);
    increment.velocity = per_substep * change, increment.spin = per_substep * spin_change;
    // The first substep adds an increment to this, so that the mean is the given velocity.
    const Real lead = Real(0.5) * (1 + per_substep);
    motion.velocity -= lead * change, motion.angular_velocity -= lead * spin_change;
    any = true;
  }
  return any;
}

template <class Real>
void end_kinematic_ramps(WorldData<Real>& w, double h, int substeps) {
  const std::vector<VelocityIncrement<Real>>& increments = w.scratch.solver.velocity_increments;
  for (std::size_t i = 0; i < increments.size(); ++i) {
    SolverBody<Real>& motion = w.motion[increments[i].body];
    if (is_dynamic(motion) || w.bodies[increments[i].body].type != BodyType::Kinematic) continue;
    const BodyVelocity<Real>& given = w.scratch.solver.start_velocities[i];
    motion.velocity = given.velocity, motion.angular_velocity = given.angular_velocity;
    motion.delta_position = displacement_by(given.velocity, static_cast<Real>(h), substeps);
    motion.delta_angle = displacement_by(given.angular_velocity, static_cast<Real>(h), substeps);
  }
}

template <class Real>
void integrate_velocities(WorldData<Real>& w) {
  for_each_increment(w, [&w](VelocityIncrement<Real>& increment) {
    if (increment.in_tree) return;
    SolverBody<Real>& motion = w.motion[increment.body];
    apply(increment, motion);
    increment.velocity_before = motion.velocity, increment.spin_before = motion.angular_velocity;
  });
}

template <class Real>
void integrate_and_warm_start(WorldData<Real>& w) {
  for_each_increment(w, [&w](VelocityIncrement<Real>& increment) {
    if (increment.in_tree) return;
    SolverBody<Real>& motion = w.motion[increment.body];
    const Vec2<Real> gained = motion.velocity - increment.velocity_before;
    const Real spin_gained = motion.angular_velocity - increment.spin_before;
    apply(increment, motion);
    increment.velocity_before = motion.velocity, increment.spin_before = motion.angular_velocity;
    motion.velocity += gained, motion.angular_velocity += spin_gained;
  });
}

template <class Real>
void integrate_positions(WorldData<Real>& w, Real h, Integrator integrator) {
  const Real weight = Real(old_velocity_weight(integrator));
  for_each_increment(w, [&w, h, weight](const VelocityIncrement<Real>& increment) {
    if (increment.in_tree) return;
    SolverBody<Real>& motion = w.motion[increment.body];
    if (increment.locked_x) motion.velocity.x = 0;
    if (increment.locked_y) motion.velocity.y = 0;
    motion.delta_position += h * motion.velocity;
    Real delta_angle = h * motion.angular_velocity;
    if (weight != 0 && motion.velocity == increment.velocity_before &&
        motion.angular_velocity == increment.spin_before && increment.damping_factor == 1 &&
        increment.spin_damping_factor == 1 && w.bodies[increment.body].first_joint == kNone &&
        is_dynamic(motion)) {
      motion.delta_position -= (weight * h) * increment.velocity;
      delta_angle -= (weight * h) * increment.spin;
      if (increment.locked_x) motion.delta_position.x = 0;
      if (increment.locked_y) motion.delta_position.y = 0;
    }
    if (delta_angle == 0) return;
    motion.delta_angle += delta_angle;
    w.rotation[increment.body] = rotated_by(w.rotation[increment.body], delta_angle);
  });
}

template <class Real>
void enforce_motion_locks(WorldData<Real>& w) {
  for (const VelocityIncrement<Real>& increment : w.scratch.solver.velocity_increments) {
    SolverBody<Real>& motion = w.motion[increment.body];
    if (increment.locked_x) motion.delta_position.x = motion.velocity.x = 0;
    if (increment.locked_y) motion.delta_position.y = motion.velocity.y = 0;
  }
}

template <class Real>
Vec2d free_acceleration(const WorldData<Real>& w, int body) {
  const double scale = static_cast<double>(w.extras_of(body).gravity_scale);
  const Vec2<Real> force = w.motion[body].inverse_mass * w.loads.get(body).force;
  return scale * w.settings.gravity + force.template as<double>();
}

template <class Real>
Real bounce_threshold(const WorldData<Real>& w, double dt) {
  if (w.settings.thresholds.bounce >= 0) return static_cast<Real>(w.settings.thresholds.bounce);
  return static_cast<Real>(tuning::kBounceThresholdSteps * dt *
                           std::sqrt(length_squared(w.settings.gravity)));
}

#define PLUMB_FOR(Real)                                                                        \
  template VelocityIncrement<Real> velocity_increment_of(const WorldData<Real>&, int, double); \
  template void prepare_integration(WorldData<Real>&, double, int, Integrator);                \
  template bool ramp_kinematic_velocities(WorldData<Real>&, double, int);                      \
  template void end_kinematic_ramps(WorldData<Real>&, double, int);                            \
  template void integrate_velocities(WorldData<Real>&);                                        \
  template void integrate_and_warm_start(WorldData<Real>&);                                    \
  template void integrate_positions(WorldData<Real>&, Real, Integrator);                       \
  template void enforce_motion_locks(WorldData<Real>&);                                        \
  template Vec2d free_acceleration(const WorldData<Real>&, int);                               \
  template Real bounce_threshold(const WorldData<Real>&, double);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
