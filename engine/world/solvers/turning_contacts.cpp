#include "engine/world/solvers/turning_contacts.h"

#include <algorithm>
#include <cmath>

#include "engine/collision/distance/time_of_impact.h"
#include "engine/math/small_rotation.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/contact_solver/contact_passes.h"
#include "engine/world/islands/direct_islands.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/internal_edges.h"
#include "engine/world/step/speculative_contact.h"

namespace plumb {
namespace {

// Most times that a contact is solved again in a substep. Each one may find another corner.
constexpr int kMostLooks = 4;
// Depth, as a fraction of the smaller extent, from which a manifold's normal may belong to the wrong side: an
// earlier one is used then.
constexpr double kMaxManifoldDepth = 0.25;

// The motion of a contact's bodies in the next substep.
template <class Real>
struct SubstepMotion {
  SubstepMotion(const WorldData<Real>& w, const ContactRecord& contact, Real substep)
      : a(w.motion[contact.body_a]),
        b(w.motion[contact.body_b]),
        q_a(w.rotation[contact.body_a]),
        q_b(w.rotation[contact.body_b]),
        a_to_b(centres_a_to_b(w, contact) + (b.delta_position - a.delta_position)),
        h(substep) {}

  // Returns the sweeps of both, relative to a's centre of mass.
  Sweep<double> sweep_a() const { return sweep_of(a, q_a, {}); }
  Sweep<double> sweep_b() const { return sweep_of(b, q_b, a_to_b); }

  const SolverBody<Real>&a, &b;
  Rotation<Real> q_a, q_b;
  Vec2<Real> a_to_b;  // m, at its start
  Real h;

 private:
  Sweep<double> sweep_of(const SolverBody<Real>& body, Rotation<Real> q, Vec2<Real> start) const {
    return {start.template as<double>(), (h * body.velocity).template as<double>(),
            Rotation<double>{static_cast<double>(q.c), static_cast<double>(q.s)},
            static_cast<double>(h * body.angular_velocity)};
  }
};

// Returns the contact after a fraction of the substep; displacement and rotations count from the step's
// start.
template <class Real>
SpeculativeContact<Real> contact_at(const WorldData<Real>& w, const ContactRecord& contact,
                                    const SubstepMotion<Real>& m, Real fraction, Real margin) {
  SpeculativeContact<Real> at;
  const Real time = fraction * m.h;
  const Real turn_a = time * m.a.angular_velocity, turn_b = time * m.b.angular_velocity;
  const Vec2<Real> moved = time * (m.b.velocity - m.a.velocity);
  at.displacement = (m.b.delta_position - m.a.delta_position) + moved;
  at.delta_angle_a = m.a.delta_angle + turn_a, at.delta_angle_b = m.b.delta_angle + turn_b;
  at.a_to_b = m.a_to_b + moved;
  at.rotation = rotated_by(m.q_a, turn_a);
  const Rotation<Real> to_a = at.rotation.inverse(), q = rotated_by(m.q_b, turn_b);
  const Pose<Real> b_in_a{to_a * at.a_to_b, {to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s}};
  at.manifold = collide_shapes(w, contact, b_in_a, margin, l1_norm(at.displacement));
  return at;
}

template <class Real>
Real least_separation(const ContactManifold<Real>& manifold) {
  const Real first = manifold.points[0].separation;
  return manifold.count == 2 ? std::min(first, manifold.points[1].separation) : first;
}

// Finds the contact that counts in the substep. Returns false if the shapes pass each other. `least`: m, the
// separation now if they overlap, else 0.
template <class Real>
bool find_contact(const WorldData<Real>& w, const ContactRecord& contact, const SubstepMotion<Real>& m,
                  Real smaller, Real margin, SpeculativeContact<Real>& at, Real& least) {
  const Real tolerance = Real(tuning::kImpactTolerance) * smaller;
  at = contact_at(w, contact, m, Real(0), margin);
  const Real now = at.manifold.count > 0 ? least_separation(at.manifold) : margin;
  least = std::min(now, Real(0));
  if (now > tolerance) {
    const ImpactResult<Real> impact =
        time_of_impact(w.convex(contact.shape_a), m.sweep_a(), w.convex(contact.shape_b), m.sweep_b(),
                       Real(0), tolerance, tuning::kToiIterations);
    if (impact.state == ImpactResult<Real>::State::Separated) return false;
    at = contact_at(w, contact, m, impact.fraction, margin);
    return at.manifold.count > 0;
  }
  for (const Real fraction : {Real(1), Real(0.5)}) {
    const SpeculativeContact<Real> later = contact_at(w, contact, m, fraction, margin);
    if (later.manifold.count == 0 || least_separation(later.manifold) < least - tolerance) continue;
    at = later;
    break;
  }
  return at.manifold.count > 0;
}

// Returns true if the bodies' motion since the step's start, up to the substep's end, takes a point farther
// from its tangent, or turns a normal farther about a corner, than a recycled manifold tolerates. Until then
// the points of the step's start hold.
template <class Real>
bool has_turned(const WorldData<Real>& w, const ContactRecord& contact, Real h) {
  const ShapeForm<Real>&form_a = w.forms[contact.shape_a], &form_b = w.forms[contact.shape_b];
  const auto deviation = [&](int body, Real radius) {
    const SolverBody<Real>& motion = w.motion[body];
    const Real turn = std::abs(motion.delta_angle) + h * std::abs(motion.angular_velocity);
    // Points of a disc that turns about its centre stay on its surface.
    return Real(0.5) * turn * turn * std::max(w.extents[body] - radius, Real(0));
  };
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Vec2<Real> passed = (b.delta_position - a.delta_position) + h * (b.velocity - a.velocity);
  const Real smaller = std::min(form_a.extent, form_b.extent);
  return deviation(contact.body_a, form_a.radius) + deviation(contact.body_b, form_b.radius) +
             Real(0.5) * length_squared(passed) / smaller >
         Real(tuning::kRecycleDistance) * smaller;
}

// Sets a contact's points. Extrapolated back to the present, none overlaps by more than `least`, m.
template <class Real>
void set_points(const WorldData<Real>& w, const ContactRecord& contact, const SubstepMotion<Real>& m,
                const SpeculativeContact<Real>& at, Real least, ContactConstraint<Real>& c) {
  const Real approach[2] = {c.approach[0], c.approach[1]},
             pressed[2] = {c.max_normal_impulse[0], c.max_normal_impulse[1]};
  prepare_speculative_contact(w, contact, at, c, c.normal_impulse);
  for (int i = 0; i < 2; ++i) c.approach[i] = approach[i], c.max_normal_impulse[i] = pressed[i];
  c.recycle_budget = -1;
  const Real along = dot(c.normal, m.b.delta_position - m.a.delta_position);
  for (int i = 0; i < c.count; ++i) {
    const Real moved = along + (c.arm_b[i] * m.b.delta_angle - c.arm_a[i] * m.a.delta_angle);
    c.current_separation[i] = std::max(c.separation[i] + moved, least);
    c.separation[i] = c.current_separation[i] - moved;
  }
}

// Disables a contact until its points are computed again: without masses it gives no impulses.
template <class Real>
void disable(ContactConstraint<Real>& c) {
  c.normal_impulse[0] = c.normal_impulse[1] = c.tangent_impulse = c.rolling_impulse = 0;
  c.mass[0] = c.mass[1] = c.inverse_pp = c.inverse_pq = c.inverse_qq = c.tangent_mass = 0;
  c.recycle_budget = -1;
}

// Calls `act` for the pair of a contact's bodies, and stores their velocities.
template <class Real, class Act>
void with_pair(WorldData<Real>& w, const ContactConstraint<Real>& c, const Act& act) {
  SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  BodyPair<Real, SolverBody<Real>&, FreeAxes<Real>> pair{a, b, c.normal, FreeAxes<Real>(a, b, c)};
  act(pair);
  if (is_dynamic(a)) a.velocity = pair.va, a.angular_velocity = pair.wa;
  if (is_dynamic(b)) b.velocity = pair.vb, b.angular_velocity = pair.wb;
}

// Moves the impulses of this substep to a contact's new rows: those of points that stay act along them
// instead. Those of points that are gone have acted.
template <class Real>
void move_impulses(WorldData<Real>& w, ContactConstraint<Real> before, const ContactConstraint<Real>& c) {
  bool any_stays = false;
  for (int i = 0; i < before.count; ++i) {
    const bool stays =
        before.features[i] == c.features[0] || (c.count == 2 && before.features[i] == c.features[1]);
    before.normal_impulse[i] = stays ? -before.normal_impulse[i] : 0;
    any_stays = any_stays || stays;
  }
  before.tangent_impulse = any_stays ? -before.tangent_impulse : 0;
  before.rolling_impulse = any_stays ? -before.rolling_impulse : 0;
  with_pair(w, before, [&](auto& pair) { warm_start_contact<Real>(pair, before); });
  with_pair(w, c, [&](auto& pair) { warm_start_contact<Real>(pair, c); });
}

// Solves a contact such that its gaps close by no more than 0, as a relaxation does.
template <class Real>
void solve_without_push(WorldData<Real>& w, ContactConstraint<Real>& c, const ContactStep<Real>& step) {
  const auto bias = [&](int i) {
    return NormalBias<Real>{std::max(c.current_separation[i], Real(0)) * step.inverse_h, 1, 0};
  };
  with_pair(w, c, [&](auto& pair) {
    if (c.count == 2) {
      solve_normal_block(pair, c, bias(0), bias(1));
    } else {
      solve_normal(pair, c, bias(0));
    }
  });
  if (c.tracking != ImpactTracking::Off) record_max_impulse(c);
}

}  // namespace

template <class Real>
void collect_turning_contacts(WorldData<Real>& w) {
  std::erase_if(w.scratch.narrow_phase.turning_contacts, [&](int id) {
    const ContactRecord& contact = w.contacts[id];
    return contact.home != ContactHome::Graph || constraint_of(w, contact).restitution > 0 ||
           !enabled(Switch::TurningContacts);
  });
}

template <class Real>
bool renew_turning_contacts(WorldData<Real>& w, Real h) {
  bool any = false;
  for (const int id : w.scratch.narrow_phase.turning_contacts) {
    const ContactRecord& contact = w.contacts[id];
    if (!has_turned(w, contact, h)) continue;
    ContactConstraint<Real>& c = constraint_of(w, contact);
    const SubstepMotion<Real> m(w, contact, h);
    any = true;
    const Real extent_a = w.forms[contact.shape_a].extent, extent_b = w.forms[contact.shape_b].extent;
    SpeculativeContact<Real> at;
    Real least;
    if (find_contact(w, contact, m, std::min(extent_a, extent_b),
                     speculative_margin(m.a, m.b, extent_a, extent_b, h), at, least)) {
      set_points(w, contact, m, at, least, c);
    } else {
      disable(c);
    }
  }
  if (!any) return false;
  for (const int id : w.scratch.narrow_phase.turning_contacts)
    if (has_turned(w, w.contacts[id], h)) renew_island_of(w, constraint_of(w, w.contacts[id]));
  return true;
}

template <class Real>
void solve_turning_contacts(WorldData<Real>& w, const ContactStep<Real>& step) {
  for (const int id : w.scratch.narrow_phase.turning_contacts) {
    const ContactRecord& contact = w.contacts[id];
    ContactConstraint<Real>& c = constraint_of(w, contact);
    if (w.bodies[contact.body_a].first_joint != kNone || w.bodies[contact.body_b].first_joint != kNone)
      continue;
    if (!has_turned(w, contact, step.h)) continue;
    const Real extent_a = w.forms[contact.shape_a].extent, extent_b = w.forms[contact.shape_b].extent,
               smaller = std::min(extent_a, extent_b);
    Real least = 0;
    for (int i = 0; i < c.count; ++i) least = std::min(least, c.current_separation[i]);
    bool changed = false;
    for (int look = 0; look < kMostLooks; ++look) {
      const SubstepMotion<Real> m(w, contact, step.h);
      const Real margin = speculative_margin(m.a, m.b, extent_a, extent_b, step.h);
      SpeculativeContact<Real> at = contact_at(w, contact, m, Real(1), margin);
      if (at.manifold.count == 0 ||
          least_separation(at.manifold) >= least - Real(tuning::kImpactTolerance) * smaller)
        break;
      for (const Real fraction : {Real(0.5), Real(0.25)})
        if (at.manifold.count > 0 && least_separation(at.manifold) < -Real(kMaxManifoldDepth) * smaller)
          at = contact_at(w, contact, m, fraction, margin);
      if (at.manifold.count == 0) break;
      solve_without_push(w, c, step);  // pushing overlaps out is no impact
      const ContactConstraint<Real> before = c;
      set_points(w, contact, m, at, least, c);
      move_impulses(w, before, c);
      solve_without_push(w, c, step);
      changed = true;
    }
    if (changed) renew_island_of(w, c);
  }
}

#define PLUMB_FOR(Real)                                         \
  template void collect_turning_contacts(WorldData<Real>&);     \
  template bool renew_turning_contacts(WorldData<Real>&, Real); \
  template void solve_turning_contacts(WorldData<Real>&, const ContactStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
