#include "engine/world/contact_solver/position_contacts.h"

#include <algorithm>
#include <cmath>

#include "engine/world/contact_solver/contact_rows.h"
#include "engine/world/contact_solver/velocity_change.h"

namespace plumb {
namespace {

template <class Real>
bool bounces(const ContactConstraint<Real>& c, int i, const PositionStep<Real>& step) {
  return c.restitution > 0 && c.approach[i] < -step.bounce_threshold;
}

template <class Real>
Real normal_sum(const ContactConstraint<Real>& c) {
  return c.normal_impulse[0] + c.normal_impulse[1];
}

// Stops sliding and rolling completely if the friction cone permits it, else not at all.
template <class Real>
void solve_static_friction(ContactPair<Real>& pair) {
  ContactConstraint<Real>& c = pair.c;
  const Real sticking = pair.sticking_impulse();
  if (std::abs(sticking) <= c.friction * normal_sum(c)) pair.set_friction(sticking);
  if (c.rolling_arm == 0) return;
  const Real sticking_torque = pair.sticking_torque();
  if (std::abs(sticking_torque) <= c.rolling_arm * normal_sum(c)) pair.set_rolling(sticking_torque);
}

// Sets the normal velocities of points with an impulse: of all, or only of those that bounce or approach.
template <class Real>
void solve_normal_velocities(SolverBody<Real>* motion, ContactConstraint<Real>& c,
                             const PositionStep<Real>& step, bool all) {
  ContactPair<Real> pair(motion, c);
  pair.record_max_impulse();
  Real target[2] = {};
  bool active[2] = {};
  for (int i = 0; i < c.count; ++i) {
    const bool bounced = bounces(c, i, step);
    active[i] = c.normal_impulse[i] > 0 && (all || bounced || pair.normal_velocity(i) < 0);
    if (bounced) target[i] = -effective_restitution(c) * c.approach[i];
  }
  pair.solve_normal_block(target, active[0], active[1]);
  pair.record_max_impulse();
}

}  // namespace

template <class Real>
void prepare_position_contacts(SolverBody<Real>* motion, ContactGraph<Real>& graph) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    c.normal_impulse[0] = c.normal_impulse[1] = c.tangent_impulse = c.rolling_impulse = 0;
    c.load_estimate[0] = c.load_estimate[1] = 0;
    if (c.tracking == ImpactTracking::Off) return;
    const ContactPair<Real> pair(motion, c);
    for (int i = 0; i < c.count; ++i) {
      if (c.max_normal_impulse[i] == 0) c.approach[i] = pair.normal_velocity(i);
    }
  });
}

template <class Real>
void project_contacts(SolverBody<Real>* motion, Rotation<Real>* rotation, ContactGraph<Real>& graph,
                      const PositionStep<Real>& step, PositionFriction friction) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    ContactPair<Real> pair(motion, c);
    const Vec2<Real> velocity_a = pair.a.velocity, velocity_b = pair.b.velocity;
    const Real spin_a = pair.a.angular_velocity, spin_b = pair.b.angular_velocity;
    // The separation at the start of the substep: the point may close this gap, or must remove this overlap.
    Real target[2] = {};
    for (int i = 0; i < c.count; ++i) {
      const Real start = pair.separation(i) - step.h * pair.normal_velocity(i);
      target[i] = std::min(-start * step.inverse_h, c.depenetration_speed);
    }
    pair.solve_normal_block(target, true, c.count == 2);
    if (friction == PositionFriction::Static) {
      solve_static_friction(pair);
    } else {
      pair.solve_friction_and_rolling();
    }
    move_by_velocity_change(pair.a, rotation[c.body_a], velocity_a, spin_a, step.h);
    move_by_velocity_change(pair.b, rotation[c.body_b], velocity_b, spin_b, step.h);
  });
}

template <class Real>
void apply_restitution(SolverBody<Real>* motion, ContactGraph<Real>& graph, const PositionStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) { solve_normal_velocities(motion, c, step, false); });
}

template <class Real>
void correct_contact_velocities(SolverBody<Real>* motion, ContactGraph<Real>& graph,
                                const PositionStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    solve_normal_velocities(motion, c, step, true);
    ContactPair<Real>(motion, c).solve_friction_and_rolling();
  });
}

#define PLUMB_FOR(Real)                                                                               \
  template void prepare_position_contacts(SolverBody<Real>*, ContactGraph<Real>&);                    \
  template void project_contacts(SolverBody<Real>*, Rotation<Real>*, ContactGraph<Real>&,             \
                                 const PositionStep<Real>&, PositionFriction);                        \
  template void apply_restitution(SolverBody<Real>*, ContactGraph<Real>&, const PositionStep<Real>&); \
  template void correct_contact_velocities(SolverBody<Real>*, ContactGraph<Real>&, const PositionStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
