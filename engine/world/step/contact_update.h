#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/step/common_rotation.h"
#include "engine/world/step/expected_impacts.h"
#include "engine/world/step/lasting_contact.h"
#include "engine/world/step/recycled_manifold.h"
#include "engine/world/step/separating_face.h"
#include "engine/world/step/speculative_contact.h"

// Updates one contact: reads the world, and changes nothing but the contact and the lists of its block. So
// blocks of contacts may be updated at the same time. Each is called from one or two places, and inlined
// there.
namespace plumb {

/// Changes of a contact found by an update, as flags.
enum : std::uint8_t {
  kTouchChange = 1,     ///< the contact begins or ends touching
  kSeparated = 2,       ///< its fat AABBs have separated
  kEnded = 4,           ///< the contact has no points any more
  kBounces = 8,         ///< see begin_contact_step
  kRebuilt = 16,        ///< its points were recomputed: new impulses are not stored yet
  kNeedsPreSolve = 32,  ///< the pre-solve hook is to be called for its new points
  kLeftFatAabb = 64,    ///< a shape has left its fat AABB
  kStale = 128,         ///< its bodies have moved too far for its points
};

/// Returns true if the fat AABBs do not overlap. Tests the tight AABBs first: they lie within the fat ones,
/// and are already loaded.
template <class Real>
[[gnu::always_inline]] inline bool fat_aabbs_apart(WorldData<Real>& w, const ContactRecord& contact) {
  if (w.tight_aabbs[contact.shape_a].overlaps(w.tight_aabbs[contact.shape_b])) return false;
  const auto stored = [&](int shape, int body) -> const Aabb<Real>& {
    return w.tree_of(w.bodies[body].type).box(w.shapes[shape].proxy);
  };
  return !stored(contact.shape_a, contact.body_a).overlaps(stored(contact.shape_b, contact.body_b));
}

/// Updates the load estimate: most of the load, or all of it if the load pressed the shapes into each other.
template <class Real>
[[gnu::always_inline]] inline void update_load_estimate(ContactConstraint<Real>& c) {
  if (!enabled(Switch::LoadEstimates)) return;
  constexpr Real kFraction = Real(tuning::kLoadEstimateFraction), kRate = Real(tuning::kLoadEstimateRate);
  constexpr Real kRise =
      Real((1 - tuning::kLoadEstimateFraction) * tuning::kDepenetrationSpeed / tuning::kLoadEstimateOverlap);
  const Real rise = kRise / c.depenetration_speed;
  for (int i = 0; i < 2; ++i) {
    const Real fraction = std::min(kFraction + rise * std::max(-c.separation[i], Real(0)), Real(1));
    c.load_estimate[i] += kRate * (fraction * c.normal_impulse[i] - c.load_estimate[i]);
  }
}

/// Begins a step of a constraint. Returns true if it has restitution, or may be of two discs that approach
/// fast.
template <class Real>
bool begin_contact_step(const WorldData<Real>& w, ContactConstraint<Real>& c, Real dt) {
  update_load_estimate(c);
  c.current_separation[0] = c.separation[0], c.current_separation[1] = c.separation[1];
  if (c.tracking == ImpactTracking::Off) return false;
  c.max_normal_impulse[0] = c.max_normal_impulse[1] = c.step_impulse = 0;
  const SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Real along = dot(c.normal, b.velocity - a.velocity);
  for (int i = 0; i < c.count; ++i) {
    c.approach[i] = along + c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity;
  }
  if (c.tracking == ImpactTracking::Reports) return false;
  // A single point with a fast approach may belong to two discs, whose normal will rotate.
  const Real travel = c.depenetration_speed * Real(tuning::kRecycleDistance / tuning::kDepenetrationSpeed);
  return c.restitution > 0 || (c.count == 1 && -c.approach[0] * dt > travel);
}

template <class Real>
bool has_touched(const ContactConstraint<Real>& c) {
  const Real near_enough =
      c.depenetration_speed * Real(tuning::kTouchSeparation / tuning::kDepenetrationSpeed);
  // A contact that bounced off within a step has touched, too.
  return c.separation[0] <= near_enough || (c.count == 2 && c.separation[1] <= near_enough) || has_pressed(c);
}

template <class Real>
ContactManifold<Real> new_manifold(const WorldData<Real>& w, const ContactRecord& contact, Real dt) {
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Real margin =
      speculative_margin(a, b, w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent, dt);
  if (aabbs_apart(w, contact.shape_a, contact.shape_b, margin)) return {};
  return manifold_of(w, contact, margin);
}

/// Returns true if a contact without points is farther apart than its shapes may approach in the step: it
/// then has no manifold and no predicted impact. Tests their AABBs, and the face that separated them before.
/// This rejects most pairs of a dense pile. The approach used here is an upper bound of those that the
/// manifold and the prediction compute, rounding included.
template <class Real>
[[gnu::always_inline]] inline bool is_beyond_margin(const WorldData<Real>& w, const ContactRecord& contact,
                                                    std::uint8_t face, Real dt) {
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Real form_a = w.forms[contact.shape_a].extent, form_b = w.forms[contact.shape_b].extent;
  const Real rotation_speed = std::abs(a.angular_velocity) * std::max(form_a, w.extents[contact.body_a]) +
                              std::abs(b.angular_velocity) * std::max(form_b, w.extents[contact.body_b]);
  const Real smaller = std::min(form_a, form_b);
  const Real rounding = 1 + 4 * std::numeric_limits<Real>::epsilon();
  const Real approach = rounding * (dt * (l1_norm(b.velocity - a.velocity) + rotation_speed));
  // The search for segments ahead looks within a margin, with an approach of its own, around the whole path.
  const bool along_chain = w.forms[contact.shape_a].chain;
  const Real margin =
      Real(tuning::kSpeculativeMargin) * (along_chain ? form_b : smaller) + (along_chain ? 2 : 1) * approach;
  if (aabbs_apart(w, contact.shape_a, contact.shape_b, margin)) return true;
  // Shapes that approach faster are searched along their curved paths, for which a face at the start says
  // little.
  return enabled(Switch::SeparatingFaces) && face != kNoFace &&
         approach <= Real(tuning::kMaxSpeculativeApproach) * smaller &&
         are_separated_by(w, contact, face, margin);
}

/// Returns true if the user's pre-solve hook is to be called for a contact.
template <class Real>
bool needs_pre_solve_call(const WorldData<Real>& w, const ContactRecord& contact) {
  return contact.pre_solve && w.pre_solve;
}

/// Starts a contact that had no points and now has some, computed by `build`.
template <class Real, class Build>
void begin_contact_with(WorldData<Real>& w, int block, int id, Real dt, bool loaded, const Build& build) {
  const ContactRecord& contact = w.contacts[id];
  BegunContact<Real> begun{.loaded = loaded, .needs_pre_solve = needs_pre_solve_call(w, contact)};
  ContactConstraint<Real>& c = begun.constraint;
  c.body_a = contact.body_a, c.body_b = contact.body_b, c.contact = id;
  mix_materials(w, contact, c);
  build(c);
  if (!begun.needs_pre_solve) begun.bounces = begin_contact_step(w, c, dt);
  if (turns_in_step(w, c, dt)) w.scratch.narrow_phase.found_turning.add(block, id);
  w.scratch.narrow_phase.begun_contacts.add(block, begun);
}

/// Prepares a contact at a predicted impact. Its plane is that of the impact, not of the middle of a step,
/// from where recycling turns planes on (recycled_manifold.h): if body a turns, the manifold is kept for this
/// step only. A box that was created on a turning plate would otherwise sink by r x^2 / 2 in each step.
template <class Real>
void prepare_predicted_contact(const WorldData<Real>& w, const ContactRecord& contact,
                               const SpeculativeContact<Real>& at, ContactConstraint<Real>& c,
                               Real (&impulse)[2]) {
  prepare_impact_contact(w, contact, at, c, impulse);
  if (w.motion[contact.body_a].angular_velocity != 0) c.recycle_budget = Real(-1);
}

/// Starts a contact without points at a predicted impact; impacts in free flight are decided later. Bodies
/// that touch, and rotate together rather than approach, have straight paths that meet, too, but ride from
/// the first step on, unless they bounce. `closest`: the manifold at the step's start.
template <class Real>
[[gnu::always_inline]] inline void begin_speculative_contact(WorldData<Real>& w, int block, int id,
                                                             const ContactManifold<Real>& closest,
                                                             const SpeculativeContact<Real>& at, Real dt) {
  const ContactRecord& contact = w.contacts[id];
  ContactConstraint<Real> c;
  c.body_a = contact.body_a, c.body_b = contact.body_b, c.contact = id;
  mix_materials(w, contact, c);
  prepare_predicted_contact(w, contact, at, c, c.normal_impulse);
  const bool rides = !(c.restitution > 0) && rebuild_rotating_contact(w, contact, closest, dt, c);
  if (!rides && is_impact_in_flight(w, at, c, dt)) {
    w.scratch.narrow_phase.found_impacts.add(block, ExpectedImpact<Real>{.constraint = c});
    return;
  }
  begin_contact_with(w, block, id, dt, true, [&](ContactConstraint<Real>& begun) { begun = c; });
}

/// Prefetches contact records kRecords ahead and, once these are loaded, their bodies and shapes kShapes
/// ahead: they are scattered in memory. `id_at(i)` is the i-th of `count` contacts. Always inlined, because
/// GCC 12 drops calls of a function that only prefetches.
template <class Real, class IdAt>
[[gnu::always_inline]] inline void prefetch_contacts(const WorldData<Real>& w, int i, int count,
                                                     const IdAt& id_at) {
  constexpr int kRecords = 16, kShapes = 8;
  if (i + kRecords < count) __builtin_prefetch(&w.contacts[id_at(i + kRecords)]);
  if (i + kShapes >= count) return;
  const ContactRecord& contact = w.contacts[id_at(i + kShapes)];
  for (const int body : {contact.body_a, contact.body_b})
    __builtin_prefetch(&w.bodies[body]), __builtin_prefetch(&w.motion[body]);
  for (const int shape : {contact.shape_a, contact.shape_b})
    __builtin_prefetch(&w.shapes[shape]), __builtin_prefetch(&w.tight_aabbs[shape]);
}

/// Returns true if the bodies' present velocities carry a point of a manifold across its plane, within the
/// step or the substep after it, which the solver looks at too. A point that nearly touches must cross by
/// more than a recycled manifold tolerates; otherwise it rests.
template <class Real>
bool crosses_plane(const WorldData<Real>& w, const ContactRecord& contact,
                   const ContactManifold<Real>& manifold, Real dt, Real h) {
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const ShapeForm<Real>&form_a = w.forms[contact.shape_a], &form_b = w.forms[contact.shape_b];
  const Real time = dt + h, angle_a = time * a.angular_velocity, angle_b = time * b.angular_velocity;
  const Rotation<Real> q = w.rotation[contact.body_a];
  const Vec2<Real> n = q * manifold.normal, a_to_b = centres_a_to_b(w, contact);
  const Real along = time * dot(n, b.velocity - a.velocity);
  const Real tolerance = Real(tuning::kRecycleDistance) * std::min(form_a.extent, form_b.extent);
  // Points of a disc that turns about its centre stay on its surface.
  const Real arm_a = std::max(w.extents[contact.body_a] - form_a.radius, Real(0)),
             arm_b = std::max(w.extents[contact.body_b] - form_b.radius, Real(0));
  const Real bend = Real(0.5) * (angle_a * angle_a * arm_a + angle_b * angle_b * arm_b);
  for (int i = 0; i < manifold.count; ++i) {
    const Vec2<Real> arm = q * manifold.points[i].point;
    const Real separation = manifold.points[i].separation,
               end = separation + along + cross(arm - a_to_b, n) * angle_b - cross(arm, n) * angle_a;
    if (end < (separation > tolerance ? bend : -tolerance)) return true;
  }
  return false;
}

/// Returns true if a contact keeps its plane although its bodies' straight paths miss each other. The paths
/// leave out the loads of other contacts and of joints, which may press a body onto the surface: without the
/// plane, a wheel that rolls onto a new tile falls for a whole step. A plane that the paths do not cross
/// holds the loads, and deflects no body that passes a corner. A loaded body follows a chain from segment to
/// segment, across its planes too: otherwise a disc that rolls over a hump of short segments falls for a
/// whole step.
template <class Real>
bool keeps_plane(const WorldData<Real>& w, const ContactRecord& contact,
                 const ContactManifold<Real>& manifold, Real dt, Real h) {
  const auto bears_contact = [&](int body) { return w.scratch.narrow_phase.has_contact_load[body] != 0; };
  const auto has_joint = [&](int body) { return w.is_dynamic(body) && w.bodies[body].first_joint != kNone; };
  const bool loaded = bears_contact(contact.body_a) || bears_contact(contact.body_b);
  if (loaded && w.forms[contact.shape_a].chain && enabled(Switch::SegmentsAhead)) return true;
  return (loaded || has_joint(contact.body_a) || has_joint(contact.body_b)) &&
         !crosses_plane(w, contact, manifold, dt, h);
}

/// Updates a contact without points: starts it if it gets points, and ends the touch of an impact in flight
/// if it gets none.
template <class Real>
[[gnu::always_inline]] inline int update_nontouching(WorldData<Real>& w, int block, int id, Real dt, Real h) {
  const ContactRecord& contact = w.contacts[id];
  const int touch_change = contact.touching ? kTouchChange : 0;
  if ((w.enlarged[contact.body_a] || w.enlarged[contact.body_b]) && fat_aabbs_apart(w, contact))
    return kSeparated;
  std::uint8_t& face = w.scratch.narrow_phase.separating_faces[id];
  if (is_beyond_margin(w, contact, face, dt)) return touch_change;
  const ContactManifold<Real> manifold = new_manifold(w, contact, dt);
  if (manifold.separating != kNoFace) face = manifold.separating;
  const SpeculativeContact<Real> at = find_speculative_contact(w, contact, manifold, false, dt, h);
  if (at.prediction == ImpactPrediction::Hit) {
    begin_speculative_contact(w, block, id, manifold, at, dt);
    return 0;
  }
  if (const SpeculativeContact<Real> arriving = arriving_contact(w, contact, manifold, dt);
      arriving.manifold.count > 0) {
    begin_contact_with(w, block, id, dt, false, [&](ContactConstraint<Real>& c) {
      prepare_speculative_contact(w, contact, arriving, c, c.normal_impulse);
    });
    return 0;
  }
  if (const SpeculativeContact<Real> ahead = segment_ahead(w, contact, manifold, dt, h);
      ahead.manifold.count > 0) {
    begin_contact_with(w, block, id, dt, false, [&](ContactConstraint<Real>& c) {
      prepare_predicted_contact(w, contact, ahead, c, c.normal_impulse);
    });
    return 0;
  }
  if (manifold.count == 0) return touch_change;
  if (at.prediction == ImpactPrediction::Miss && !keeps_plane(w, contact, manifold, dt, h))
    return touch_change;
  begin_contact_with(w, block, id, dt, false, [&](ContactConstraint<Real>& c) {
    prepare_rotating_contact(w, contact, manifold, dt, c, c.normal_impulse);
  });
  return 0;
}

/// Rebuilds a manifold; returns false if it has no points. Impact searches of other contacts still read the
/// old impulses, so the new ones wait in `c.now` until all contacts were updated.
template <class Real>
[[gnu::always_inline]] inline bool rebuild_manifold(WorldData<Real>& w, int block,
                                                    const ContactRecord& contact, Real dt, Real h,
                                                    ContactConstraint<Real>& c) {
  if (rebuild_lasting_contact(w, contact, dt, c)) return true;
  const ContactManifold<Real> manifold = new_manifold(w, contact, dt);
  if (rebuild_rotating_contact(w, contact, manifold, dt, c)) return true;
  if (const SpeculativeContact<Real> ahead = segment_ahead(w, contact, manifold, dt, h);
      ahead.manifold.count > 0) {
    // Overlaps of a plane extrapolated back are not real, and are not pushed out.
    prepare_predicted_contact(w, contact, ahead, c, c.current_separation);
    return true;
  }
  const bool pressed = c.normal_impulse[0] > 0 || c.normal_impulse[1] > 0;
  const SpeculativeContact<Real> at = find_speculative_contact(w, contact, manifold, pressed, dt, h);
  if (at.prediction == ImpactPrediction::Hit) {
    prepare_predicted_contact(w, contact, at, c, c.current_separation);
    ContactConstraint<Real> updated = c;
    updated.normal_impulse[0] = c.current_separation[0], updated.normal_impulse[1] = c.current_separation[1];
    if (is_impact_in_flight(w, at, updated, dt)) {
      w.scratch.narrow_phase.found_impacts.add(block,
                                               ExpectedImpact<Real>{.constraint = updated, .in_graph = true});
    } else {
      w.scratch.narrow_phase.found_loaded.add(block, {c.body_a, c.body_b});
    }
  } else {
    prepare_rotating_contact(w, contact, manifold, dt, c, c.current_separation);
  }
  // The prediction ignores the load that a contact carries: keep a contact that holds a body.
  const bool loaded = c.current_separation[0] > 0 || c.current_separation[1] > 0;
  return c.count > 0 &&
         (loaded || at.prediction != ImpactPrediction::Miss || keeps_plane(w, contact, manifold, dt, h));
}

/// Recycles a contact with points, using only its constraint and its bodies' motion. Returns kStale if they
/// have moved too far for that, and kLeftFatAabb if its shapes may have separated.
template <class Real>
[[gnu::always_inline]] inline int recycle_contact(WorldData<Real>& w, ContactConstraint<Real>& c, Real dt,
                                                  bool shared) {
  mark_pushers(w, c, shared);
  // Includes contacts that end in this update. Applied after the loop or, if a hook throws, in the next step.
  const int touch = has_touched(c) != c.touching ? kTouchChange : 0;
  const int left = (w.enlarged[c.body_a] | w.enlarged[c.body_b]) != 0 ? kLeftFatAabb : 0;
  if (!recycle_manifold(w, c, w.extents[c.body_a], w.extents[c.body_b])) return touch | left | kStale;
  return touch | left | (begin_contact_step(w, c, dt) ? kBounces : 0);
}

/// Ends a contact with points whose shapes have separated, or rebuilds its manifold. `change` is the result
/// of `recycle_contact`; adds further flags to it.
template <class Real>
[[gnu::always_inline]] inline int rebuild_contact(WorldData<Real>& w, int block, ContactConstraint<Real>& c,
                                                  int change, Real dt, Real h) {
  const ContactRecord& contact = w.contacts[c.contact];
  if ((change & kLeftFatAabb) != 0 && fat_aabbs_apart(w, contact))
    return (change & kTouchChange) | kSeparated;
  const int known = change & ~(kLeftFatAabb | kStale);
  if ((change & kStale) == 0) return known;
  const bool has_points = rebuild_manifold(w, block, contact, dt, h, c);
  if (has_points && turns_in_step(w, c, dt)) w.scratch.narrow_phase.found_turning.add(block, c.contact);
  return known | kRebuilt | (!has_points ? kEnded : needs_pre_solve_call(w, contact) ? kNeedsPreSolve : 0);
}

}  // namespace plumb
