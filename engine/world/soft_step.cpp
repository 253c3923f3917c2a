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

// What a body's velocity gains and keeps in a time of its own accord.
template <class Real>
Kick<Real> kick_of(const WorldData<Real>& w, int body, double time) {
  const BodyRecord<Real>& record = w.bodies[body];
  const BodyMotion<Real>& motion = w.motion[body];
  const Real t = static_cast<Real>(time);
  Kick<Real> kick;
  kick.body = body;
  if (record.type != BodyType::Dynamic) return kick;
  const Vec2<Real> gravity = w.settings.gravity.template as<Real>();
  kick.velocity = t * (record.gravity_scale * gravity + motion.inverse_mass * record.force);
  kick.spin = t * motion.inverse_inertia * record.torque;
  if (record.linear_damping > 0) kick.keep = static_cast<Real>(decay(time * double(record.linear_damping)));
  if (record.angular_damping > 0)
    kick.keep_spin = static_cast<Real>(decay(time * double(record.angular_damping)));
  kick.locked_x = record.lock_x, kick.locked_y = record.lock_y;
  return kick;
}

template <class Real>
void apply(const Kick<Real>& kick, BodyMotion<Real>& motion) {
  motion.velocity = kick.keep * (motion.velocity + kick.velocity);
  motion.angular_velocity = kick.keep_spin * (motion.angular_velocity + kick.spin);
  if (kick.locked_x) motion.velocity.x = 0;
  if (kick.locked_y) motion.velocity.y = 0;
}

// In free flight constant acceleration is exact: x(t) = x + v t + a t^2/2 = x + (v(t) - a t/2) t.
template <class Real>
void fly(WorldData<Real>& w, int body, double dt) {
  const Kick<Real> kick = kick_of(w, body, dt);
  BodyMotion<Real>& motion = w.motion[body];
  const Real t = static_cast<Real>(dt);
  const Vec2<Real> before = motion.velocity;
  const Real spin_before = motion.angular_velocity;
  apply(kick, motion);
  // The mean of both ends: exact for constant acceleration, of second order with damping.
  motion.moved = (Real(0.5) * t) * (before + motion.velocity);
  if (kick.locked_x) motion.moved.x = 0;
  if (kick.locked_y) motion.moved.y = 0;
  motion.turned = Real(0.5) * t * (spin_before + motion.angular_velocity);
  if (motion.turned != 0) w.rotation[body] = turned_by(w.rotation[body], motion.turned);
}

// Bodies that nothing holds fly through the whole step at once; the others get their kicks substep by
// substep.
template <class Real>
void prepare_kicks(WorldData<Real>& w, double h, int substeps) {
  w.scratch.kicks.clear();
  for (const int body : w.awake) {
    if (w.bodies[body].constraints == 0) {
      fly(w, body, h * substeps);
      continue;
    }
    w.motion[body].moved = {}, w.motion[body].turned = 0;
    w.scratch.kicks.push_back(kick_of(w, body, h));
  }
}

template <class Real>
void integrate_velocities(WorldData<Real>& w) {
  for (const Kick<Real>& kick : w.scratch.kicks) apply(kick, w.motion[kick.body]);
}

template <class Real>
void integrate_positions(WorldData<Real>& w, Real h) {
  for (const Kick<Real>& kick : w.scratch.kicks) {
    BodyMotion<Real>& motion = w.motion[kick.body];
    if (kick.locked_x) motion.velocity.x = 0;
    if (kick.locked_y) motion.velocity.y = 0;
    motion.moved += h * motion.velocity;
    const Real turn = h * motion.angular_velocity;
    if (turn == 0) continue;
    motion.turned += turn;
    w.rotation[kick.body] = turned_by(w.rotation[kick.body], turn);
  }
}

// A contact's spring, that yields less to loads than it gives way to motion.
template <class Real>
Softness<Real> contact_softness(double frequency_share, double h) {
  Softness<Real> soft = softness<Real>(frequency_share / h, tuning::kContactDampingRatio, h);
  soft.impulse_scale *= Real(tuning::kContactYield);
  soft.mass_scale = 1 - soft.impulse_scale;
  return soft;
}

}  // namespace

template <class Real>
void solve_soft_steps(WorldData<Real>& w, double h, int substeps) {
  const Real warm_start = w.last_h > 0 ? static_cast<Real>(h / w.last_h) : Real(1);
  const Vec2d gravity = w.settings.gravity;
  ContactStep<Real> contacts{.inverse_h = static_cast<Real>(1 / h),
                             .softness = {contact_softness<Real>(tuning::kContactFrequencyShare, h),
                                          contact_softness<Real>(tuning::kStiffFrequencyShare, h),
                                          Softness<Real>{static_cast<Real>(tuning::kPushShare / h), 1, 0}},
                             .warm_start = warm_start,
                             .bounce_threshold = static_cast<Real>(tuning::kRestingSteps * h * substeps *
                                                                   std::sqrt(length_squared(gravity)))};
  JointStep<Real> joints{
      .h = static_cast<Real>(h),
      .inverse_h = static_cast<Real>(1 / h),
      .softness = softness<Real>(tuning::kJointFrequencyShare / h, tuning::kJointDampingRatio, h),
      .warm_start = warm_start};
  const SolverBodies<Real> bodies = w.solver_bodies();
  const bool jointed = w.joint_set.active_count() > 0;

  prepare_kicks(w, h, substeps);
  if (jointed) w.joint_set.prepare(bodies, joints);
  prepare_direct_islands(w, joints);
  for (int substep = 0; substep < substeps; ++substep) {
    integrate_velocities(w);
    if (jointed) w.joint_set.warm_start(bodies, joints);
    warm_start_contacts(bodies.motion, w.graph, contacts);
    if (jointed) w.joint_set.solve(bodies, joints);
    solve_direct_islands(w, contacts, joints, true);
    solve_contacts(bodies.motion, w.graph, contacts);
    integrate_positions(w, static_cast<Real>(h));
    if (jointed) w.joint_set.relax(bodies, joints);
    solve_direct_islands(w, contacts, joints, false);
    relax_contacts(bodies.motion, w.graph, contacts);
    contacts.warm_start = joints.warm_start = 1;
  }
  apply_restitution(bodies.motion, w.graph, contacts);
  finish_direct_islands(w);
}

template void solve_soft_steps(WorldData<float>&, double, int);
template void solve_soft_steps(WorldData<double>&, double, int);

}  // namespace plumb
