#include <algorithm>
#include <cmath>

#include "engine/math/trigonometry.h"
#include "engine/solve/soft_contacts.h"
#include "engine/world/constants.h"
#include "engine/world/direct_islands.h"
#include "engine/world/step.h"

namespace plumb {
namespace {

// exp(-x) for x >= 0 without a library: exp(-x / 2^k)^(2^k) with the series where it is short.
double decay(double x) {
  int halvings = 0;
  for (; x > 0.125; x *= 0.5) ++halvings;
  // 1 - x + x^2/2 - ... to x^9/9!: below rounding for x <= 1/8.
  double sum = 1;
  for (int n = 9; n >= 1; --n) sum = 1 - x / n * sum;
  for (; halvings > 0; --halvings) sum *= sum;
  return sum;
}

// Forces that act through the whole step become kicks for its substeps.
template <class Real>
void prepare_kicks(WorldData<Real>& w, double h) {
  w.kicks.resize(w.awake.size());
  const Vec2<Real> gravity = w.settings.gravity.template as<Real>();
  const Real step = static_cast<Real>(h);
  for (std::size_t i = 0; i < w.awake.size(); ++i) {
    const int body = w.awake[i];
    const BodyRecord<Real>& record = w.bodies[body];
    BodyMotion<Real>& motion = w.motion[body];
    motion.moved = {}, motion.turned = 0;
    Kick<Real>& kick = w.kicks[i];
    kick = {};
    if (record.type != BodyType::Dynamic) continue;
    kick.velocity = step * (record.gravity_scale * gravity + motion.inverse_mass * record.force);
    kick.spin = step * motion.inverse_inertia * record.torque;
    if (record.linear_damping > 0) kick.keep = static_cast<Real>(decay(h * double(record.linear_damping)));
    if (record.angular_damping > 0)
      kick.keep_spin = static_cast<Real>(decay(h * double(record.angular_damping)));
    if (record.constraints == 0) kick.lag = Real(0.5) * kick.velocity, kick.lag_spin = Real(0.5) * kick.spin;
    if (record.lock_x) kick.locked_x = true, kick.velocity.x = kick.lag.x = motion.velocity.x = 0;
    if (record.lock_y) kick.locked_y = true, kick.velocity.y = kick.lag.y = motion.velocity.y = 0;
  }
}

template <class Real>
void integrate_velocities(WorldData<Real>& w) {
  for (std::size_t i = 0; i < w.awake.size(); ++i) {
    const Kick<Real>& kick = w.kicks[i];
    BodyMotion<Real>& motion = w.motion[w.awake[i]];
    motion.velocity = kick.keep * (motion.velocity + kick.velocity);
    motion.angular_velocity = kick.keep_spin * (motion.angular_velocity + kick.spin);
  }
}

// Turns by a small angle: sine and cosine to the order where a float rounds, the library's own beyond.
template <class Real>
Rotation<Real> turned_by(Rotation<Real> q, Real x) {
  if (std::abs(x) > Real(0.125)) {
    const Rotation<Real> r = rotation_of(x);
    return {q.c * r.c - q.s * r.s, q.s * r.c + q.c * r.s};
  }
  const Real x2 = x * x;
  const Real s = x * (1 - x2 * (Real(1) / 6) * (1 - x2 * (Real(1) / 20) * (1 - x2 * (Real(1) / 42))));
  const Real c = 1 - x2 * Real(0.5) * (1 - x2 * (Real(1) / 12) * (1 - x2 * (Real(1) / 30)));
  return {q.c * c - q.s * s, q.s * c + q.c * s};
}

template <class Real>
void integrate_positions(WorldData<Real>& w, Real h) {
  for (std::size_t i = 0; i < w.awake.size(); ++i) {
    const Kick<Real>& kick = w.kicks[i];
    const int body = w.awake[i];
    BodyMotion<Real>& motion = w.motion[body];
    if (kick.locked_x) motion.velocity.x = 0;
    if (kick.locked_y) motion.velocity.y = 0;
    motion.moved += h * (motion.velocity - kick.lag);
    const Real turn = h * (motion.angular_velocity - kick.lag_spin);
    if (turn == 0) continue;
    motion.turned += turn;
    w.rotation[body] = turned_by(w.rotation[body], turn);
  }
}

}  // namespace

template <class Real>
void solve_soft_steps(WorldData<Real>& w, double h, int substeps) {
  const Real warm_start = w.last_h > 0 ? static_cast<Real>(h / w.last_h) : Real(1);
  const Vec2d gravity = w.settings.gravity;
  ContactStep<Real> contacts{
      .inverse_h = static_cast<Real>(1 / h),
      .softness = {softness<Real>(tuning::kContactFrequencyShare / h, tuning::kContactDampingRatio, h),
                   softness<Real>(tuning::kStiffFrequencyShare / h, tuning::kContactDampingRatio, h),
                   Softness<Real>{static_cast<Real>(tuning::kPushShare / h), 1, 0}},
      .warm_start = warm_start,
      .bounce_threshold =
          static_cast<Real>(tuning::kRestingSteps * h * substeps * std::sqrt(length_squared(gravity)))};
  JointStep<Real> joints{
      .h = static_cast<Real>(h),
      .inverse_h = static_cast<Real>(1 / h),
      .softness = softness<Real>(tuning::kJointFrequencyShare / h, tuning::kJointDampingRatio, h),
      .warm_start = warm_start};
  const SolverBodies<Real> bodies = w.solver_bodies();
  const bool jointed = w.joint_set.active_count() > 0;

  prepare_kicks(w, h);
  if (jointed) w.joint_set.prepare(bodies, joints);
  prepare_direct_islands(w);
  for (int substep = 0; substep < substeps; ++substep) {
    integrate_velocities(w);
    if (jointed) w.joint_set.warm_start(bodies, joints);
    warm_start_contacts(bodies.motion, w.graph, contacts);
    solve_direct_islands(w, contacts, true);
    if (jointed) w.joint_set.solve(bodies, joints);
    solve_contacts(bodies.motion, w.graph, contacts);
    integrate_positions(w, static_cast<Real>(h));
    solve_direct_islands(w, contacts, false);
    if (jointed) w.joint_set.relax(bodies, joints);
    relax_contacts(bodies.motion, w.graph, contacts);
    contacts.warm_start = joints.warm_start = 1;
  }
  apply_restitution(bodies.motion, w.graph, contacts);
  finish_direct_islands(w);
}

template void solve_soft_steps(WorldData<float>&, double, int);
template void solve_soft_steps(WorldData<double>&, double, int);

}  // namespace plumb
