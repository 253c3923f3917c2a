#include "engine/world/step/lasting_contact.h"

#include <algorithm>
#include <cmath>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/math/small_turn.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/seams.h"
#include "engine/world/step/speculative_contact.h"

namespace plumb {
namespace {

// Deviation of a body's turning points from their tangents in half a step, as a fraction of its half width,
// up to which contacts are taken at the middle of the step. Continuous collision stops bodies that are deeper
// than half of it between the step's ends. From a 256th to a sixteenth all scenarios keep their bounds, and
// blocks that tip over and discs that roll off change their errors by less than a factor of 2.
constexpr double kLastingBend = 1.0 / 64;

// Returns the contact at the middle of the step, without points if it does not last.
template <class Real>
SpeculativeContact<Real> lasting_contact(const WorldData<Real>& w, const ContactRecord& contact,
                                         const ContactConstraint<Real>& c, Real dt) {
  SpeculativeContact<Real> at;
  const BodyMotion<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Real half = Real(0.5) * dt, smaller = c.push_speed * Real(1 / tuning::kPushSpeed);
  at.closed = half * (b.velocity - a.velocity);
  at.turned_a = half * a.angular_velocity, at.turned_b = half * b.angular_velocity;
  const auto bends = [&](int body, Real turn) {
    return w.is_dynamic(body) &&
           Real(0.5) * turn * turn * w.extents[body] > Real(kLastingBend) * w.bodies[body].half_width;
  };
  if (bends(c.body_a, at.turned_a) || bends(c.body_b, at.turned_b)) return at;
  const Real along = dot(c.normal, at.closed);
  bool lasts = false;
  Real deepest = 0;
  for (int i = 0; i < c.count; ++i) {
    deepest = std::min(deepest, c.now[i]);
    if (c.now[i] > Real(tuning::kRecycleDistance) * smaller) continue;
    const Real change = along + (c.arm_b[i] * at.turned_b - c.arm_a[i] * at.turned_a);
    if (std::abs(change) > Real(tuning::kRecycleDistance) * smaller) return at;
    lasts = true;
  }
  if (!lasts) return at;
  at.between = between_bodies(w, contact) + at.closed;
  at.rotation = turned_by(w.rotation[c.body_a], at.turned_a);
  const Rotation<Real> to_a = at.rotation.inverse(), q = turned_by(w.rotation[c.body_b], at.turned_b);
  const Pose<Real> b_in_a{to_a * at.between, {to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s}};
  const Real reach =
      speculative_margin(a, b, w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent, dt);
  at.manifold = collide_shapes(w, contact, b_in_a, reach, size_of(at.closed));
  for (int i = 0; i < at.manifold.count; ++i)
    if (at.manifold.points[i].separation < deepest - Real(tuning::kRecycleDistance) * smaller) return {};
  return at;
}

}  // namespace

template <class Real>
bool renew_lasting(const WorldData<Real>& w, const ContactRecord& contact, Real dt,
                   ContactConstraint<Real>& c) {
  const SpeculativeContact<Real> lasting = lasting_contact(w, contact, c, dt);
  if (lasting.manifold.count == 0) return false;
  const Real deepest = std::min({c.now[0], c.count == 2 ? c.now[1] : Real(0), Real(0)});
  prepare_speculative_contact(w, contact, lasting, c, c.now);
  // Points leave their tangents on the way back to the start. What that may be is no overlap to push out.
  const auto bend = [&](int body, int shape, Real turn) {
    return Real(0.5) * turn * turn * std::max(w.extents[body] - w.forms[shape].radius, Real(0));
  };
  const Real bends = bend(contact.body_a, contact.shape_a, lasting.turned_a) +
                     bend(contact.body_b, contact.shape_b, lasting.turned_b);
  for (int i = 0; i < c.count; ++i)
    if (c.separation[i] < deepest) c.separation[i] = std::min(deepest, c.separation[i] + bends);
  return true;
}

template bool renew_lasting(const WorldData<float>&, const ContactRecord&, float, ContactConstraint<float>&);
template bool renew_lasting(const WorldData<double>&, const ContactRecord&, double,
                            ContactConstraint<double>&);

}  // namespace plumb
