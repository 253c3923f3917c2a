#include "engine/world/step/expected_impacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/capacity.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/step/pushers.h"

namespace plumb {
namespace {

// Impacts whose times differ by less than this fraction of the step are simultaneous. With four substeps this
// is the same time as in impact propagation.
constexpr double kSimultaneous = 2.5e-4;

template <class Real>
Real separation_rate(const WorldData<Real>& w, const ContactConstraint<Real>& c, int i) {
  const SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  return dot(c.normal, b.velocity - a.velocity) + c.arm_b[i] * b.angular_velocity -
         c.arm_a[i] * a.angular_velocity;
}

// Returns true if a close point neither separates nor is about to bounce. A velocity that moves the point by
// no more than rounding in a step does not count as separation: its sign may change within the step.
// Otherwise the impact would be left to continuous collision before the step, but belong to the solver after
// it.
template <class Real>
bool is_resting_point(const WorldData<Real>& w, const ContactConstraint<Real>& c, int i, Real dt) {
  const Real rate = separation_rate(w, c, i);
  return !(dt * rate > rounding_overlap(w, c.body_a, c.body_b)) &&
         !(c.restitution > 0 && -rate > bounce_threshold(w, static_cast<double>(dt)));
}

// Returns true if a dynamic body without joints moves so far in a step that continuous collision sweeps it.
template <class Real>
bool moves_far(const WorldData<Real>& w, int body, Real dt) {
  const SolverBody<Real>& motion = w.motion[body];
  const Real speed = std::abs(motion.velocity.x) + std::abs(motion.velocity.y) +
                     std::abs(motion.angular_velocity) * w.extents[body];
  return w.is_dynamic(body) && w.bodies[body].first_joint == kNone &&
         dt * speed > Real(tuning::kFastFraction) * w.bodies[body].half_width;
}

// Returns true if a body is in free flight until its impact, without locked axes, or is not dynamic.
template <class Real>
bool is_in_free_flight(const WorldData<Real>& w, int body, Real dt) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.type != BodyType::Dynamic) return true;
  if (w.scratch.narrow_phase.is_loaded[body] || record.first_joint != kNone) return false;
  if (record.lock_x || record.lock_y) return false;
  return !any_edge(w.contacts, record.first_contact, [&](const ContactRecord& contact) {
    return contact.home == ContactHome::Sleeping ||
           (contact.home == ContactHome::Graph &&
            is_load_bearing(w, w.graph.at({contact.colour, contact.index}), dt));
  });
}

// Adds a dynamic body to a list, unless the list contains it.
template <class Real>
void add_once(const WorldData<Real>& w, std::vector<int>& list, std::vector<char>& listed, int body) {
  if (!w.is_dynamic(body)) return;
  if (listed.size() < w.motion.size()) listed.resize(w.motion.size());
  if (listed[body]) return;
  listed[body] = 1;
  append(list, body);
}

// Returns the time until a contact's first point closes, s, at the bodies' present velocities.
template <class Real>
Real time_of_contact(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  Real first = std::numeric_limits<Real>::infinity();
  for (int i = 0; i < c.count; ++i) {
    const Real rate = separation_rate(w, c, i);
    if (rate < 0) first = std::min(first, std::max(-c.separation[i] / rate, Real(0)));
  }
  return first;
}

// Leaves bodies whose first impact is with two or more others at once to the solver, which resolves
// simultaneous impacts together: a bar that falls flat on two posts leaves both at the same speed. Impacts
// one after the other take place in flight, at their own times, because those after a body's first one may
// change or not happen. Without restitution, dynamic bodies stay together and press on others within the
// step, which only contacts can pass on: such impacts with several bodies are left to the solver, as are
// those of bodies that may reach a third one (`are_alone`).
template <class Real>
void assign_simultaneous_impacts(WorldData<Real>& w, Real dt) {
  if (!enabled(Switch::SimultaneousImpacts)) return;
  std::vector<char>& listed = w.scratch.narrow_phase.expects_impact;
  std::vector<Real>& earliest = w.scratch.solver.impacts.earliest;  // by body
  if (earliest.size() < w.motion.size()) resize_with_growth(earliest, static_cast<int>(w.motion.size()));
  const auto concerns = [&](const ContactConstraint<Real>& c) {
    return c.restitution > 0 || (w.is_dynamic(c.body_a) && w.is_dynamic(c.body_b));
  };
  for (const ExpectedImpact<Real>& impact : w.scratch.narrow_phase.expected_impacts) {
    if (!concerns(impact.constraint)) continue;
    const Real time = time_of_contact(w, impact.constraint);
    for (const int body : {impact.constraint.body_a, impact.constraint.body_b}) {
      const bool first = listed.size() <= static_cast<std::size_t>(body) || !listed[body];
      earliest[body] = first ? time : std::min(earliest[body], time);
      if (first) add_once(w, w.scratch.narrow_phase.impact_bodies, listed, body);
    }
  }
  for (const int body : w.scratch.narrow_phase.impact_bodies) listed[body] = 0;
  w.scratch.narrow_phase.impact_bodies.clear();
  for (const ExpectedImpact<Real>& impact : w.scratch.narrow_phase.expected_impacts) {
    if (!concerns(impact.constraint)) continue;
    const Real time = time_of_contact(w, impact.constraint);
    for (const int body : {impact.constraint.body_a, impact.constraint.body_b}) {
      if (impact.constraint.restitution > 0 && time > earliest[body] + Real(kSimultaneous) * dt) continue;
      if (listed.size() > static_cast<std::size_t>(body) && listed[body]) {
        add_once(w, w.scratch.narrow_phase.loaded_bodies, w.scratch.narrow_phase.is_loaded, body);
      } else {
        add_once(w, w.scratch.narrow_phase.impact_bodies, listed, body);
      }
    }
  }
  for (const int body : w.scratch.narrow_phase.impact_bodies) listed[body] = 0;
  w.scratch.narrow_phase.impact_bodies.clear();
}

}  // namespace

template <class Real>
bool are_alone(const WorldData<Real>& w, int body_a, int body_b, Real dt) {
  const SolverBody<Real>&a = w.motion[body_a], &b = w.motion[body_b];
  const auto speed = [&](Vec2<Real> v, Real spin_speed) {
    return std::abs(v.x) + std::abs(v.y) + spin_speed;
  };
  const Real spin_a = std::abs(a.angular_velocity) * w.extents[body_a],
             spin_b = std::abs(b.angular_velocity) * w.extents[body_b];
  const Real relative = speed(b.velocity - a.velocity, spin_a + spin_b);
  const auto reaches_third = [&](int body, Real own_speed) {
    const Real reach = dt * (own_speed + relative);
    return any_edge(w.contacts, w.bodies[body].first_contact, [&](const ContactRecord& contact) {
      if ((contact.body_a == body_a && contact.body_b == body_b) ||
          (contact.body_a == body_b && contact.body_b == body_a))
        return false;
      return w.tight_aabbs[contact.shape_a].grown(reach).overlaps(w.tight_aabbs[contact.shape_b]);
    });
  };
  return !reaches_third(body_a, speed(a.velocity, spin_a)) &&
         !reaches_third(body_b, speed(b.velocity, spin_b));
}

template <class Real>
bool turns_in_step(WorldData<Real>& w, const ContactConstraint<Real>& c, Real dt) {
  if (!w.is_dynamic(c.body_a) || !w.is_dynamic(c.body_b)) return false;
  const SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Real along = dot(c.normal, b.velocity - a.velocity);
  Real closing = 0;
  for (int i = 0; i < c.count; ++i)
    closing = std::max(closing, -(along + c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity));
  const Real smaller = c.depenetration_speed * Real(1 / tuning::kDepenetrationSpeed);
  // Deviation of a turning point from its tangent, and of a normal about a corner that is passed.
  const auto deviation = [&](const SolverBody<Real>& body, int index) {
    const Real turn = dt * body.angular_velocity;
    return turn * turn * w.extents[index];
  };
  const Real passed = dt * closing;
  if (!(deviation(a, c.body_a) + deviation(b, c.body_b) + passed * passed / smaller >
        Real(2 * tuning::kRecycleDistance) * smaller))
    return false;
  if (is_pressed_by_third(w, c.body_a, c.body_b) || is_pressed_by_third(w, c.body_b, c.body_a)) return false;
  const auto has_joint = [&](int body) { return w.bodies[body].first_joint != kNone; };
  // `Direct` keeps its rows through a step: new ones open joints by a micrometre.
  if (has_joint(c.body_a) || has_joint(c.body_b)) return w.settings.solver != Solver::Direct;
  return are_alone(w, c.body_a, c.body_b, dt);
}

template <class Real>
bool is_load_bearing(const WorldData<Real>& w, const ContactConstraint<Real>& c, Real dt) {
  const Real tolerance = c.depenetration_speed * Real(tuning::kRecycleDistance / tuning::kDepenetrationSpeed);
  const Real rounding = rounding_overlap(w, c.body_a, c.body_b);
  for (int i = 0; i < c.count; ++i) {
    if (c.normal_impulse[i] > 0 || !(c.separation[i] > -rounding)) return true;
    if (c.separation[i] <= tolerance && is_resting_point(w, c, i, dt)) return true;
  }
  return false;
}

template <class Real>
bool was_load_bearing(const WorldData<Real>& w, const ContactConstraint<Real>& c, Real dt) {
  if (has_pressed(c)) return true;
  if (c.tracking != ImpactTracking::Motion) return is_load_bearing(w, c, dt);
  const Real tolerance = c.depenetration_speed * Real(tuning::kRecycleDistance / tuning::kDepenetrationSpeed);
  for (int i = 0; i < c.count; ++i)
    if (c.current_separation[i] <= tolerance && is_resting_point(w, c, i, dt)) return true;
  return false;
}

template <class Real>
void clear_expected_impacts(WorldData<Real>& w) {
  Scratch<Real>& scratch = w.scratch;
  for (const int body : scratch.narrow_phase.loaded_bodies) scratch.narrow_phase.is_loaded[body] = 0;
  for (const int body : scratch.narrow_phase.impact_bodies) scratch.narrow_phase.expects_impact[body] = 0;
  scratch.narrow_phase.loaded_bodies.clear(), scratch.narrow_phase.impact_bodies.clear(),
      scratch.narrow_phase.expected_impacts.clear();
}

template <class Real>
bool is_impact_in_flight(WorldData<Real>& w, const SpeculativeContact<Real>& at,
                         const ContactConstraint<Real>& c, Real dt) {
  const bool solves_in_flight = w.settings.solver == Solver::SoftSteps || w.settings.solver == Solver::Direct;
  if (!solves_in_flight || !enabled(Switch::ImpactsInFlight)) return false;
  if (!(c.restitution > 0)) {
    if (!enabled(Switch::Landings)) return false;
    // Slower bodies strike with one corner after the other in different substeps: contacts handle them at
    // less cost.
    if (w.is_dynamic(c.body_a) && w.is_dynamic(c.body_b)) {
      const auto has_joint = [&](int body) { return w.bodies[body].first_joint != kNone; };
      if (has_joint(c.body_a) || has_joint(c.body_b) || !turns_in_step(w, c, dt)) return false;
    } else if (!moves_far(w, c.body_a, dt) && !moves_far(w, c.body_b, dt)) {
      return false;
    }
  }
  const Real min_separation =
      c.count == 2 ? std::min(at.manifold.points[0].separation, at.manifold.points[1].separation)
                   : at.manifold.points[0].separation;
  const Real smaller = c.depenetration_speed / Real(tuning::kDepenetrationSpeed);
  const SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  for (int i = 0; i < c.count; ++i) {
    if (c.normal_impulse[i] > 0) return false;
    if (at.manifold.points[i].separation > min_separation + Real(tuning::kImpactTolerance) * smaller)
      continue;
    const Real rate =
        dot(c.normal, at.velocity) + c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity;
    if (-rate > bounce_threshold(w, static_cast<double>(dt))) return true;
  }
  return false;
}

template <class Real>
void mark_loaded(WorldData<Real>& w, int body_a, int body_b) {
  add_once(w, w.scratch.narrow_phase.loaded_bodies, w.scratch.narrow_phase.is_loaded, body_a);
  add_once(w, w.scratch.narrow_phase.loaded_bodies, w.scratch.narrow_phase.is_loaded, body_b);
}

template <class Real>
void decide_expected_impacts(WorldData<Real>& w, Real dt) {
  std::vector<ExpectedImpact<Real>>& impacts = w.scratch.narrow_phase.expected_impacts;
  if (impacts.empty()) return;
  if (w.scratch.narrow_phase.is_loaded.size() < w.motion.size())
    w.scratch.narrow_phase.is_loaded.resize(w.motion.size());
  assign_simultaneous_impacts(w, dt);
  // An impact that is left to the solver may end the free flight of its bodies, which may affect their other
  // impacts.
  bool more = true;
  while (more) {
    more = false;
    for (ExpectedImpact<Real>& impact : impacts) {
      const ContactConstraint<Real>& c = impact.constraint;
      if (impact.left_to_solver) continue;
      const bool sticks = !(c.restitution > 0) && w.is_dynamic(c.body_a) && w.is_dynamic(c.body_b);
      if (is_in_free_flight(w, c.body_a, dt) && is_in_free_flight(w, c.body_b, dt) &&
          !(sticks && !are_alone(w, c.body_a, c.body_b, dt)))
        continue;
      impact.left_to_solver = more = true;
      mark_loaded(w, c.body_a, c.body_b);
    }
  }
  for (const ExpectedImpact<Real>& impact : impacts) {
    if (impact.left_to_solver) continue;
    add_once(w, w.scratch.narrow_phase.impact_bodies, w.scratch.narrow_phase.expects_impact,
             impact.constraint.body_a);
    add_once(w, w.scratch.narrow_phase.impact_bodies, w.scratch.narrow_phase.expects_impact,
             impact.constraint.body_b);
  }
}

#define PLUMB_FOR(Real)                                                                         \
  template bool are_alone(const WorldData<Real>&, int, int, Real);                              \
  template bool turns_in_step(WorldData<Real>&, const ContactConstraint<Real>&, Real);          \
  template bool is_load_bearing(const WorldData<Real>&, const ContactConstraint<Real>&, Real);  \
  template bool was_load_bearing(const WorldData<Real>&, const ContactConstraint<Real>&, Real); \
  template void clear_expected_impacts(WorldData<Real>&);                                       \
  template bool is_impact_in_flight(WorldData<Real>&, const SpeculativeContact<Real>&,          \
                                    const ContactConstraint<Real>&, Real);                      \
  template void mark_loaded(WorldData<Real>&, int, int);                                        \
  template void decide_expected_impacts(WorldData<Real>&, Real);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
