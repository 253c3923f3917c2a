#include "engine/world/contact_solver/position_contacts.h"

#include <algorithm>
#include <cmath>

#include "engine/world/contact_solver/contact_rows.h"
#include "engine/world/contact_solver/follow.h"

namespace plumb {
namespace {

template <class Real>
bool bounces(const ContactConstraint<Real>& c, int i, const PositionStep<Real>& step) {
  return c.restitution > 0 && c.approach[i] < -step.bounce_threshold;
}

template <class Real>
Real pressure(const ContactConstraint<Real>& c) {
  return c.normal_impulse[0] + c.normal_impulse[1];
}

// Stops sliding and rolling completely if the friction cone permits it, otherwise not at all.
template <class Real>
void hold_still(ContactPair<Real>& pair) {
  ContactConstraint<Real>& c = pair.c;
  const Real held = pair.holding_impulse();
  if (std::abs(held) <= c.friction * pressure(c)) pair.rub(held);
  if (c.rolling_arm == 0) return;
  const Real torque = pair.holding_torque();
  if (std::abs(torque) <= c.rolling_arm * pressure(c)) pair.roll(torque);
}

// Sets the normal velocities of pressed points: of all, or only of those that bounce or approach.
template <class Real>
void leave(SolverBody<Real>* motion, ContactConstraint<Real>& c, const PositionStep<Real>& step, bool all) {
  ContactPair<Real> pair(motion, c);
  pair.note_peaks();
  Real wanted[2] = {};
  bool pressed[2] = {};
  for (int i = 0; i < c.count; ++i) {
    const bool bounce = bounces(c, i, step);
    pressed[i] = c.normal_impulse[i] > 0 && (all || bounce || pair.normal_rate(i) < 0);
    if (bounce) wanted[i] = -c.restitution * c.approach[i];
  }
  pair.press(wanted, pressed[0], pressed[1]);
  pair.note_peaks();
}

}  // namespace

template <class Real>
void begin_position_contacts(SolverBody<Real>* motion, ContactGraph<Real>& graph) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    c.normal_impulse[0] = c.normal_impulse[1] = c.tangent_impulse = c.rolling_impulse = 0;
    c.load_estimate[0] = c.load_estimate[1] = 0;
    if (c.watched == Watch::Off) return;
    const ContactPair<Real> pair(motion, c);
    for (int i = 0; i < c.count; ++i) {
      if (c.peak_impulse[i] == 0) c.approach[i] = pair.normal_rate(i);
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
    Real wanted[2] = {};
    for (int i = 0; i < c.count; ++i) {
      const Real start = pair.separation(i) - step.h * pair.normal_rate(i);
      wanted[i] = std::min(-start * step.inverse_h, c.push_speed);
    }
    pair.press(wanted, true, c.count == 2);
    if (friction == PositionFriction::Static) {
      hold_still(pair);
    } else {
      pair.rub_and_roll();
    }
    follow(pair.a, rotation[c.body_a], velocity_a, spin_a, step.h);
    follow(pair.b, rotation[c.body_b], velocity_b, spin_b, step.h);
  });
}

template <class Real>
void restore_bounces(SolverBody<Real>* motion, ContactGraph<Real>& graph, const PositionStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) { leave(motion, c, step, false); });
}

template <class Real>
void correct_contact_velocities(SolverBody<Real>* motion, ContactGraph<Real>& graph,
                                const PositionStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    leave(motion, c, step, true);
    ContactPair<Real>(motion, c).rub_and_roll();
  });
}

#define PLUMB_FOR(Real)                                                                             \
  template void begin_position_contacts(SolverBody<Real>*, ContactGraph<Real>&);                    \
  template void project_contacts(SolverBody<Real>*, Rotation<Real>*, ContactGraph<Real>&,           \
                                 const PositionStep<Real>&, PositionFriction);                      \
  template void restore_bounces(SolverBody<Real>*, ContactGraph<Real>&, const PositionStep<Real>&); \
  template void correct_contact_velocities(SolverBody<Real>*, ContactGraph<Real>&, const PositionStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
