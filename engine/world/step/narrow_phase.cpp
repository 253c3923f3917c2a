#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/scene/error.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/seams.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/step/contact_reading.h"
#include "engine/world/step/expected_impacts.h"
#include "engine/world/step/speculative_contact.h"
#include "engine/world/step/step.h"

namespace plumb {
namespace {

// Returns the speculative margin: a fraction of the smaller shape's extent, plus the possible approach in the
// step.
template <class Real>
Real speculative_margin(const BodyMotion<Real>& a, const BodyMotion<Real>& b, Real extent_a, Real extent_b,
                        Real dt) {
  const Real smaller = std::min(extent_a, extent_b);
  const Real closing = dt * (size_of(b.velocity - a.velocity) + std::abs(a.angular_velocity) * extent_a +
                             std::abs(b.angular_velocity) * extent_b);
  return Real(tuning::kSpeculativeMargin) * smaller +
         std::min(closing, Real(tuning::kSpeculativeMarginMost) * smaller);
}

// Tight AABBs lie in the fat ones, and are at hand.
template <class Real>
bool fat_aabbs_apart(WorldData<Real>& w, const ContactRecord& contact) {
  if (w.boxes[contact.shape_a].overlaps(w.boxes[contact.shape_b])) return false;
  const auto stored = [&](int shape, int body) -> const Aabb<Real>& {
    return w.tree_of(w.bodies[body].type).box(w.shapes[shape].proxy);
  };
  return !stored(contact.shape_a, contact.body_a).overlaps(stored(contact.shape_b, contact.body_b));
}

// Builds a speculative constraint at the predicted impact; separations are the present ones.
template <class Real>
void prepare_speculative_contact(const WorldData<Real>& w, const ContactRecord& contact,
                                 const SpeculativeContact<Real>& at, ContactConstraint<Real>& c) {
  prepare_contact(w, contact, at.manifold, at.rotation, at.between, c);
  const Real closed = dot(c.normal, at.closed);
  for (int i = 0; i < c.count; ++i)
    c.separation[i] -= closed + (c.arm_b[i] * at.turned_b - c.arm_a[i] * at.turned_a);
}

// Recycles the manifold: updates separations to first order. Returns false if the bodies moved too much for
// that.
template <class Real>
bool recycle_manifold(const WorldData<Real>& w, ContactConstraint<Real>& c, Real extent_a, Real extent_b) {
  const BodyMotion<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Vec2<Real> shift = b.moved - a.moved;
  c.recycle_budget -= size_of(shift) + std::abs(a.turned) * extent_a + std::abs(b.turned) * extent_b;
  if (c.recycle_budget < 0) return false;
  const Real closed = dot(c.normal, shift);
  for (int i = 0; i < c.count; ++i) {
    c.separation[i] += closed + c.arm_b[i] * b.turned - c.arm_a[i] * a.turned;
  }
  return true;
}

// Updates the load estimate: most of a load, and all of it if the load pressed the shapes into each other.
template <class Real>
void update_load_estimate(ContactConstraint<Real>& c) {
  constexpr Real kShare = Real(tuning::kExpectedShare), kRate = Real(tuning::kExpectedRate);
  constexpr Real kRise = Real((1 - tuning::kExpectedShare) * tuning::kPushSpeed / tuning::kExpectedOverlap);
  const Real rise = kRise / c.push_speed;
  for (int i = 0; i < 2; ++i) {
    const Real share = std::min(kShare + rise * std::max(-c.separation[i], Real(0)), Real(1));
    c.load_estimate[i] += kRate * (share * c.normal_impulse[i] - c.load_estimate[i]);
  }
}

template <class Real>
void begin_step(WorldData<Real>& w, ContactConstraint<Real>& c, Real dt) {
  update_load_estimate(c);
  c.now[0] = c.separation[0], c.now[1] = c.separation[1];
  if (!c.watched) return;
  c.peak_impulse[0] = c.peak_impulse[1] = 0;
  const BodyMotion<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Real along = dot(c.normal, b.velocity - a.velocity);
  for (int i = 0; i < c.count; ++i) {
    c.approach[i] = along + c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity;
  }
  // A single point with a fast approach may belong to two discs, whose normal will rotate.
  const Real travel = c.push_speed * Real(tuning::kRecycleDistance / tuning::kPushSpeed);
  if (c.restitution > 0 || (c.count == 1 && -c.approach[0] * dt > travel))
    append(w.scratch.bouncing, c.contact);
}

// Updates the touching state that events report.
template <class Real>
void update_touching(WorldData<Real>& w, ContactConstraint<Real>& c, bool touching) {
  const ContactRecord& contact = w.contacts[c.contact];
  set_touching(w, c.contact, touching);
  c.touching = touching;
  c.watched = records_impact(contact, c);
  if (!c.watched) c.approach[0] = c.approach[1] = 0;
}

template <class Real>
bool touches(const ContactConstraint<Real>& c) {
  const Real near_enough = c.push_speed * Real(tuning::kTouch / tuning::kPushSpeed);
  // A contact that bounced off within a step has touched, too.
  const auto touch = [&](int i) {
    return c.separation[i] <= near_enough || c.normal_impulse[i] > 0 || (c.watched && c.peak_impulse[i] > 0);
  };
  return touch(0) || (c.count == 2 && touch(1));
}

template <class Real>
ContactManifold<Real> new_manifold(const WorldData<Real>& w, const ContactRecord& contact, Real dt) {
  const BodyMotion<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Real reach =
      speculative_margin(a, b, w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent, dt);
  if (aabbs_apart(w, contact.shape_a, contact.shape_b, reach)) return {};
  return manifold_of(w, contact, reach);
}

// Returns true if the AABBs of a contact without points are farther apart than its shapes may approach in the
// step: it has no manifold and no predicted impact. Decides most pairs of a crowd. Bounds the approaches that
// both of these compute from above, also in their rounding.
template <class Real>
bool is_out_of_reach(const WorldData<Real>& w, const ContactRecord& contact, Real dt) {
  const BodyMotion<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Real form_a = w.forms[contact.shape_a].extent, form_b = w.forms[contact.shape_b].extent;
  const Real turning = std::abs(a.angular_velocity) * std::max(form_a, w.extents[contact.body_a]) +
                       std::abs(b.angular_velocity) * std::max(form_b, w.extents[contact.body_b]);
  const Real closing = dt * (size_of(b.velocity - a.velocity) + turning);
  const Real reach = Real(tuning::kSpeculativeMargin) * std::min(form_a, form_b) +
                     (1 + 4 * std::numeric_limits<Real>::epsilon()) * closing;
  return aabbs_apart(w, contact.shape_a, contact.shape_b, reach);
}

// Returns true if the user's pre-solve hook disables a contact in this step.
template <class Real>
bool is_waived(WorldData<Real>& w, const ContactRecord& contact, ContactConstraint<Real>& c) {
  return contact.pre_solve && w.pre_solve && !w.pre_solve(c.contact, c);
}

// Prepares a new constraint, with the points that `build` makes.
template <class Real, class Build>
void begin_near(WorldData<Real>& w, int id, Real dt, const Build& build) {
  const ContactRecord& contact = w.contacts[id];
  ContactConstraint<Real> c;
  build(c);
  c.body_a = contact.body_a, c.body_b = contact.body_b, c.contact = id;
  mix_materials(w, contact, c);
  if (is_waived(w, contact, c)) return;
  begin_step(w, c, dt);
  w.scratch.begun_contacts.push_back(c);
}

// Does the same for a predicted impact; bounces in free flight are decided later.
template <class Real>
void begin_speculative_contact(WorldData<Real>& w, int id, const SpeculativeContact<Real>& at, Real dt) {
  const ContactRecord& contact = w.contacts[id];
  ContactConstraint<Real> c;
  prepare_speculative_contact(w, contact, at, c);
  c.body_a = contact.body_a, c.body_b = contact.body_b, c.contact = id;
  mix_materials(w, contact, c);
  if (will_bounce(w, contact, at, c, dt)) {
    append(w.scratch.expected_impacts, ExpectedImpact<Real>{.constraint = c});
    return;
  }
  if (is_waived(w, contact, c)) return;
  begin_step(w, c, dt);
  note_pressed(w, c);
  w.scratch.begun_contacts.push_back(c);
}

// Prefetches contact records kRecords ahead and, once these are loaded, their bodies and shapes kShapes
// ahead: they are scattered in memory. Always inlined, because GCC 12 drops calls of a function that only
// prefetches.
template <class Real>
[[gnu::always_inline]] inline void prefetch_near(const WorldData<Real>& w, std::size_t i) {
  constexpr std::size_t kRecords = 16, kShapes = 8;
  if (i + kRecords < w.near.size()) __builtin_prefetch(&w.contacts[w.near[i + kRecords]]);
  if (i + kShapes >= w.near.size()) return;
  const ContactRecord& contact = w.contacts[w.near[i + kShapes]];
  for (const int body : {contact.body_a, contact.body_b})
    __builtin_prefetch(&w.bodies[body]), __builtin_prefetch(&w.motion[body]);
  for (const int shape : {contact.shape_a, contact.shape_b})
    __builtin_prefetch(&w.shapes[shape]), __builtin_prefetch(&w.boxes[shape]);
}

// Updates contacts without points: starts those that get points, and ends those whose fat AABBs have
// separated.
template <class Real>
void update_nontouching_contacts(WorldData<Real>& w, Real dt, Real h) {
  for (std::size_t i = 0; i < w.near.size(); ++i) {
    prefetch_near(w, i);
    const int id = w.near[i];
    const ContactRecord& contact = w.contacts[id];
    if ((w.enlarged[contact.body_a] || w.enlarged[contact.body_b]) && fat_aabbs_apart(w, contact)) {
      w.scratch.lost_contacts.push_back(id);
      continue;
    }
    if (is_out_of_reach(w, contact, dt)) continue;
    const ContactManifold<Real> manifold = new_manifold(w, contact, dt);
    const SpeculativeContact<Real> at = find_speculative_contact(w, contact, manifold, dt, h);
    if (at.outlook == Outlook::Meets) {
      begin_speculative_contact(w, id, at, dt);
    } else if (manifold.count > 0 && at.outlook != Outlook::Misses) {
      begin_near(w, id, dt, [&](ContactConstraint<Real>& c) { prepare_contact(w, contact, manifold, c); });
    }
  }
}

// Rebuilds a manifold; returns false if there is none.
template <class Real>
bool renew(WorldData<Real>& w, const ContactRecord& contact, Real dt, Real h, ContactConstraint<Real>& c) {
  const ContactManifold<Real> manifold = new_manifold(w, contact, dt);
  const SpeculativeContact<Real> at = find_speculative_contact(w, contact, manifold, dt, h);
  if (at.outlook == Outlook::Meets) {
    prepare_speculative_contact(w, contact, at, c);
    if (will_bounce(w, contact, at, c, dt)) {
      append(w.scratch.expected_impacts, ExpectedImpact<Real>{.constraint = c, .in_graph = true});
    } else {
      note_pressed(w, c);
    }
  } else {
    prepare_contact(w, contact, manifold, c);
  }
  return c.count > 0 && at.outlook != Outlook::Misses;
}

// Recycles the manifold of a contact with points, or rebuilds it if its bodies have moved too much.
template <class Real>
void update_constraint(WorldData<Real>& w, ContactConstraint<Real>& c, Real dt, Real h) {
  // Includes contacts that end in this update. Applied after the loop or, if a hook throws, in the next step.
  if (touches(c) != c.touching) w.scratch.touch_changes.push_back(c.contact);
  if (w.enlarged[c.body_a] | w.enlarged[c.body_b]) {
    if (fat_aabbs_apart(w, w.contacts[c.contact])) {
      w.scratch.lost_contacts.push_back(c.contact);
      return;
    }
  }
  if (!recycle_manifold(w, c, w.extents[c.body_a], w.extents[c.body_b])) {
    const ContactRecord& contact = w.contacts[c.contact];
    if (!renew(w, contact, dt, h, c) || is_waived(w, contact, c)) {
      w.scratch.ended_contacts.push_back(c.contact);
      return;
    }
  }
  begin_step(w, c, dt);
}

}  // namespace

namespace {

// Passes predicted impacts that do not bounce in free flight to the solver.
template <class Real>
void settle_expected_impacts(WorldData<Real>& w, Real dt) {
  decide_expected_impacts(w);
  for (ExpectedImpact<Real>& impact : w.scratch.expected_impacts) {
    ContactConstraint<Real>& c = impact.constraint;
    if (impact.in_graph) {
      if (!impact.left) append(w.scratch.ended_contacts, c.contact);
    } else if (impact.left) {
      begin_step(w, c, dt);
      w.scratch.begun_contacts.push_back(c);
    } else {
      wake_body(w, c.body_a), wake_body(w, c.body_b);
    }
  }
}

}  // namespace

template <class Real>
void update_contacts(WorldData<Real>& w, Real dt, Real h) {
  auto& scratch = w.scratch;
  scratch.lost_contacts.clear(), scratch.ended_contacts.clear(), scratch.touch_changes.clear();
  scratch.begun_contacts.clear(), scratch.bouncing.clear();
  clear_expected_impacts(w);
  update_nontouching_contacts(w, dt, h);
  w.graph.for_each([&](ContactConstraint<Real>& c) { update_constraint(w, c, dt, h); });
  settle_expected_impacts(w, dt);
  for (const int id : scratch.touch_changes) {
    ContactConstraint<Real>& c = constraint_of(w, w.contacts[id]);
    update_touching(w, c, !c.touching);
  }
  for (const int id : scratch.lost_contacts) destroy_contact(w, id);
  for (const int id : scratch.ended_contacts) end_contact(w, id);
  scratch.begun_contacts.use_up([&](const ContactConstraint<Real>& c) {
    const int id = c.contact;
    const bool touching = touches(c);
    begin_contact(w, id, c);
    if (touching) update_touching(w, constraint_of(w, w.contacts[id]), true);
  });
}

template <class Real>
void report_impacts(WorldData<Real>& w) {
  const auto struck = [](const ContactConstraint<Real>& c) {
    return c.peak_impulse[0] > 0 || (c.count == 2 && c.peak_impulse[1] > 0);
  };
  for (const int id : w.scratch.bouncing) {
    if (w.contacts[id].home != ContactHome::Graph) continue;
    ContactConstraint<Real>& c = constraint_of(w, w.contacts[id]);
    if (struck(c)) set_touching(w, id, true), c.touching = true;
  }
  if (!w.reports_hits) return;
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    const ContactRecord& contact = w.contacts[c.contact];
    if (!contact.hit_events) return;
    const int hardest = c.count == 2 && c.approach[1] < c.approach[0] ? 1 : 0;
    const Real least = c.push_speed * Real(tuning::kHitSpeed / tuning::kPushSpeed);
    if (c.peak_impulse[hardest] == 0 || c.approach[hardest] > -least) return;
    set_touching(w, c.contact, true);
    c.touching = true;
    const ContactReading reading = reading_of(w, contact, c);
    w.log().hits.push_back({reading.shape_a, reading.shape_b, reading.points[hardest], reading.normal,
                            -static_cast<double>(c.approach[hardest])});
  });
}

template void report_impacts(WorldData<float>&);
template void report_impacts(WorldData<double>&);
template void update_contacts(WorldData<float>&, float, float);
template void update_contacts(WorldData<double>&, double, double);

}  // namespace plumb
