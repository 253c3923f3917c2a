#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/core/room.h"
#include "engine/scene/error.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/seams.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/step/contact_reading.h"
#include "engine/world/step/expected_impacts.h"
#include "engine/world/step/lasting_contact.h"
#include "engine/world/step/recycled_manifold.h"
#include "engine/world/step/separating_face.h"
#include "engine/world/step/speculative_contact.h"
#include "engine/world/step/step.h"

namespace plumb {
namespace {

// Returns true if the fat AABBs do not overlap. Tests the tight AABBs first: they lie within the fat ones,
// and are already loaded.
template <class Real>
bool fat_aabbs_apart(WorldData<Real>& w, const ContactRecord& contact) {
  if (w.boxes[contact.shape_a].overlaps(w.boxes[contact.shape_b])) return false;
  const auto stored = [&](int shape, int body) -> const Aabb<Real>& {
    return w.tree_of(w.bodies[body].type).box(w.shapes[shape].proxy);
  };
  return !stored(contact.shape_a, contact.body_a).overlaps(stored(contact.shape_b, contact.body_b));
}

// Updates the load estimate: most of the load, or all of it if the load pressed the shapes into each other.
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

// Begins a step of a constraint. Returns true if it has restitution, or may be of two discs that approach
// fast.
template <class Real>
bool begin_step(const WorldData<Real>& w, ContactConstraint<Real>& c, Real dt) {
  update_load_estimate(c);
  c.now[0] = c.separation[0], c.now[1] = c.separation[1];
  if (c.watched == Watch::Off) return false;
  c.peak_impulse[0] = c.peak_impulse[1] = c.step_impulse = 0;
  const BodyMotion<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Real along = dot(c.normal, b.velocity - a.velocity);
  for (int i = 0; i < c.count; ++i) {
    c.approach[i] = along + c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity;
  }
  if (c.watched == Watch::Reports) return false;
  // A single point with a fast approach may belong to two discs, whose normal will rotate.
  const Real travel = c.push_speed * Real(tuning::kRecycleDistance / tuning::kPushSpeed);
  return c.restitution > 0 || (c.count == 1 && -c.approach[0] * dt > travel);
}

// Updates the touching state that events report.
template <class Real>
void update_touching(WorldData<Real>& w, ContactConstraint<Real>& c, bool touching) {
  const ContactRecord& contact = w.contacts[c.contact];
  set_touching(w, c.contact, touching);
  c.touching = touching;
  c.watched = watch_of(contact, c);
  c.peak_impulse[0] = c.peak_impulse[1] = c.step_impulse = 0;
  if (c.watched == Watch::Off) c.approach[0] = c.approach[1] = 0;
}

template <class Real>
bool touches(const ContactConstraint<Real>& c) {
  const Real near_enough = c.push_speed * Real(tuning::kTouch / tuning::kPushSpeed);
  // A contact that bounced off within a step has touched, too.
  return c.separation[0] <= near_enough || (c.count == 2 && c.separation[1] <= near_enough) || has_pressed(c);
}

template <class Real>
ContactManifold<Real> new_manifold(const WorldData<Real>& w, const ContactRecord& contact, Real dt) {
  const BodyMotion<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Real reach =
      speculative_margin(a, b, w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent, dt);
  if (aabbs_apart(w, contact.shape_a, contact.shape_b, reach)) return {};
  return manifold_of(w, contact, reach);
}

// Returns true if a contact without points is farther apart than its shapes may approach in the step: it then
// has no manifold and no predicted impact. Tests their AABBs, and the face that separated them before. This
// rejects most pairs in a crowd. The approach used here is an upper bound of those that the manifold and the
// prediction compute, rounding included.
template <class Real>
bool is_out_of_reach(const WorldData<Real>& w, const ContactRecord& contact, std::uint8_t face, Real dt) {
  const BodyMotion<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Real form_a = w.forms[contact.shape_a].extent, form_b = w.forms[contact.shape_b].extent;
  const Real turning = std::abs(a.angular_velocity) * std::max(form_a, w.extents[contact.body_a]) +
                       std::abs(b.angular_velocity) * std::max(form_b, w.extents[contact.body_b]);
  const Real smaller = std::min(form_a, form_b);
  const Real rounding = 1 + 4 * std::numeric_limits<Real>::epsilon();
  const Real closing = rounding * (dt * (size_of(b.velocity - a.velocity) + turning));
  const Real reach = Real(tuning::kSpeculativeMargin) * smaller + closing;
  if (aabbs_apart(w, contact.shape_a, contact.shape_b, reach)) return true;
  // Shapes that approach faster are searched along their curved paths, for which a face at the start says
  // little.
  return face != kNoFace && closing <= Real(tuning::kSpeculativeMarginMost) * smaller &&
         are_separated_by(w, contact, face, reach);
}

// Returns true if the user's pre-solve hook is to be asked about a contact.
template <class Real>
bool is_asked(const WorldData<Real>& w, const ContactRecord& contact) {
  return contact.pre_solve && w.pre_solve;
}

// Changes of a contact found by an update, as flags.
enum : std::uint8_t {
  kTouchChange = 1,  // the contact begins or ends touching
  kLost = 2,         // its fat AABBs have separated
  kEnded = 4,        // the contact has no points any more
  kBounces = 8,      // see begin_step
  kRenewed = 16,     // its points were recomputed: impulses are not settled yet
  kAsked = 32,       // the user's hook decides about its new points
  kLeft = 64,        // a shape has left its fat AABB
  kStale = 128,      // its bodies have moved too far for its points
};

// Starts a contact that had no points and now has some, computed by `build`.
template <class Real, class Build>
void begin_near(WorldData<Real>& w, int block, int id, Real dt, bool pressing, const Build& build) {
  const ContactRecord& contact = w.contacts[id];
  BegunContact<Real> begun{.pressing = pressing, .asked = is_asked(w, contact)};
  ContactConstraint<Real>& c = begun.constraint;
  build(c);
  c.body_a = contact.body_a, c.body_b = contact.body_b, c.contact = id;
  mix_materials(w, contact, c);
  if (!begun.asked) begun.bounces = begin_step(w, c, dt);
  w.scratch.begun_contacts.add(block, begun);
}

// Does the same for a predicted impact; impacts in free flight are decided later.
template <class Real>
void begin_speculative_contact(WorldData<Real>& w, int block, int id, const SpeculativeContact<Real>& at,
                               Real dt) {
  const ContactRecord& contact = w.contacts[id];
  ContactConstraint<Real> c;
  prepare_meeting(w, contact, at, c, c.normal_impulse);
  c.body_a = contact.body_a, c.body_b = contact.body_b, c.contact = id;
  mix_materials(w, contact, c);
  if (meets_in_flight(w, contact, at, c, dt)) {
    w.scratch.found_impacts.add(block, ExpectedImpact<Real>{.constraint = c});
    return;
  }
  begin_near(w, block, id, dt, true, [&](ContactConstraint<Real>& begun) { begun = c; });
}

// Prefetches contact records kRecords ahead and, once these are loaded, their bodies and shapes kShapes
// ahead: they are scattered in memory. `id_at(i)` is the i-th of `count` contacts. Always inlined, because
// GCC 12 drops calls of a function that only prefetches.
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
    __builtin_prefetch(&w.shapes[shape]), __builtin_prefetch(&w.boxes[shape]);
}

// Updates a contact without points: starts it if it gets points, and ends the touch of an impact in flight if
// it gets none.
template <class Real>
int update_nontouching(WorldData<Real>& w, int block, int id, Real dt, Real h) {
  const ContactRecord& contact = w.contacts[id];
  const int parted = contact.touching ? kTouchChange : 0;
  if ((w.enlarged[contact.body_a] || w.enlarged[contact.body_b]) && fat_aabbs_apart(w, contact)) return kLost;
  std::uint8_t& face = w.scratch.separating_faces[id];
  if (is_out_of_reach(w, contact, face, dt)) return parted;
  const ContactManifold<Real> manifold = new_manifold(w, contact, dt);
  if (manifold.separating != kNoFace) face = manifold.separating;
  const SpeculativeContact<Real> at = find_speculative_contact(w, contact, manifold, dt, h);
  if (at.outlook == Outlook::Meets) {
    begin_speculative_contact(w, block, id, at, dt);
    return 0;
  }
  if (const SpeculativeContact<Real> arriving = arriving_contact(w, contact, manifold, dt);
      arriving.manifold.count > 0) {
    begin_near(w, block, id, dt, false, [&](ContactConstraint<Real>& c) {
      prepare_speculative_contact(w, contact, arriving, c, c.normal_impulse);
    });
    return 0;
  }
  if (manifold.count == 0 || at.outlook == Outlook::Misses) return parted;
  begin_near(w, block, id, dt, false,
             [&](ContactConstraint<Real>& c) { prepare_contact(w, contact, manifold, c); });
  return 0;
}

// Rebuilds a manifold; returns false if it has no points. Impact searches of other contacts still read the
// old impulses, so the new ones wait in `c.now` until all contacts were updated.
template <class Real>
bool renew(WorldData<Real>& w, int block, const ContactRecord& contact, Real dt, Real h,
           ContactConstraint<Real>& c) {
  if (renew_lasting(w, contact, dt, c)) return true;
  const ContactManifold<Real> manifold = new_manifold(w, contact, dt);
  const SpeculativeContact<Real> at = find_speculative_contact(w, contact, manifold, dt, h);
  if (at.outlook == Outlook::Meets) {
    prepare_meeting(w, contact, at, c, c.now);
    ContactConstraint<Real> settled = c;
    settled.normal_impulse[0] = c.now[0], settled.normal_impulse[1] = c.now[1];
    if (meets_in_flight(w, contact, at, settled, dt)) {
      w.scratch.found_impacts.add(block, ExpectedImpact<Real>{.constraint = settled, .in_graph = true});
    } else {
      w.scratch.found_presses.add(block, {c.body_a, c.body_b});
    }
  } else {
    prepare_contact(w, contact, manifold, w.rotation[contact.body_a], between_bodies(w, contact), c, c.now);
  }
  // The prediction ignores the load that a contact carries: keep a contact that holds a body.
  const bool holds = c.now[0] > 0 || c.now[1] > 0;
  return c.count > 0 && (holds || at.outlook != Outlook::Misses);
}

// Recycles a contact with points, using only its constraint and its bodies' motion. Returns kStale if they
// have moved too far for that, and kLeft if its shapes may have separated.
template <class Real>
int carry_on(WorldData<Real>& w, ContactConstraint<Real>& c, Real dt) {
  if (c.normal_impulse[0] > 0 || c.normal_impulse[1] > 0) note_loaded(w, c);
  // Includes contacts that end in this update. Applied after the loop or, if a hook throws, in the next step.
  const int touch = touches(c) != c.touching ? kTouchChange : 0;
  const int left = (w.enlarged[c.body_a] | w.enlarged[c.body_b]) != 0 ? kLeft : 0;
  if (!recycle_manifold(w, c, w.extents[c.body_a], w.extents[c.body_b])) return touch | left | kStale;
  return touch | left | (begin_step(w, c, dt) ? kBounces : 0);
}

// Ends a contact with points whose shapes have separated, or rebuilds its manifold. `change` is the result of
// `carry_on`; adds further flags to it.
template <class Real>
int look_again(WorldData<Real>& w, int block, ContactConstraint<Real>& c, int change, Real dt, Real h) {
  const ContactRecord& contact = w.contacts[c.contact];
  if ((change & kLeft) != 0 && fat_aabbs_apart(w, contact)) return (change & kTouchChange) | kLost;
  const int known = change & ~(kLeft | kStale);
  if ((change & kStale) == 0) return known;
  const bool has_points = renew(w, block, contact, dt, h, c);
  return known | kRenewed | (!has_points ? kEnded : is_asked(w, contact) ? kAsked : 0);
}

// Contacts per block of a shared loop: 10 to 100 us of work.
constexpr int kNearOfBlock = 128, kContactsOfBlock = 128;

// Cuts the graph's colours into blocks.
template <class Real>
void find_contact_runs(WorldData<Real>& w) {
  std::vector<ContactRun<Real>>& runs = w.scratch.contact_runs;
  runs.clear();
  // This comes first: if memory runs out, no changes of any run have been recorded.
  std::vector<std::uint8_t>& changes = w.scratch.contact_changes;
  make_room(changes, static_cast<int>(w.near.size() + w.graph.size()));
  std::fill(changes.begin(), changes.end(), std::uint8_t{0});
  std::vector<std::uint8_t>& faces = w.scratch.separating_faces;
  if (static_cast<int>(faces.size()) < w.contacts.size()) {
    ensure_room(faces, static_cast<std::size_t>(w.contacts.size()));
    faces.resize(static_cast<std::size_t>(w.contacts.size()), kNoFace);
  }
  int place = static_cast<int>(w.near.size());
  w.graph.for_each_colour([&](std::vector<ContactConstraint<Real>>& colour, bool) {
    const int count = static_cast<int>(colour.size());
    for (int first = 0; first < count; first += kContactsOfBlock) {
      const int size = std::min(kContactsOfBlock, count - first);
      append(runs, ContactRun<Real>{colour.data() + first, size, place});
      place += size;
    }
  });
}

// Stores the new impulses of a run's rebuilt contacts.
template <class Real>
void settle_impulses(WorldData<Real>& w, const ContactRun<Real>& run, Real dt) {
  std::uint8_t* const changes = w.scratch.contact_changes.data() + run.place;
  for (int i = 0; i < run.count; ++i) {
    if ((changes[i] & kRenewed) == 0) continue;
    ContactConstraint<Real>& c = run.first[i];
    c.normal_impulse[0] = c.now[0], c.normal_impulse[1] = c.now[1];
    if ((changes[i] & (kEnded | kAsked)) == 0 && begin_step(w, c, dt)) changes[i] |= kBounces;
  }
}

// Updates all contacts independently; changes that affect others are recorded.
template <class Real>
void update_each(WorldData<Real>& w, Real dt, Real h) {
  Scratch<Real>& scratch = w.scratch;
  find_contact_runs(w);
  const int near = static_cast<int>(w.near.size()), near_blocks = (near + kNearOfBlock - 1) / kNearOfBlock;
  const std::vector<ContactRun<Real>>& runs = scratch.contact_runs;
  const int blocks = near_blocks + static_cast<int>(runs.size());
  scratch.begun_contacts.begin(blocks), scratch.found_impacts.begin(blocks);
  scratch.found_presses.begin(blocks);
  std::uint8_t* const changes = scratch.contact_changes.data();
  // By run: the union of its contacts' changes.
  std::vector<int>& any = scratch.block_firsts;
  any.assign(runs.size(), 0);
  scratch.loaded.assign(w.bodies.size(), 0);
  const auto carry = [&](int block) {
    const ContactRun<Real> run = runs[block];
    for (int i = 0; i < run.count; ++i) {
      const int change = carry_on(w, run.first[i], dt);
      if (change == 0) continue;
      changes[run.place + i] = static_cast<std::uint8_t>(change);
      any[block] |= change;
    }
  };
  const auto update = [&](int block) {
    if (block < near_blocks) {
      const int first = block * kNearOfBlock, count = std::min(kNearOfBlock, near - first);
      const int* const ids = w.near.data() + first;
      for (int i = 0; i < count; ++i) {
        prefetch_contacts(w, i, count, [&](int k) { return ids[k]; });
        changes[first + i] = static_cast<std::uint8_t>(update_nontouching(w, block, ids[i], dt, h));
      }
      return;
    }
    const int all = any[block - near_blocks];
    if ((all & (kStale | kLeft)) == 0) return;
    const ContactRun<Real> run = runs[block - near_blocks];
    int places[kContactsOfBlock], count = 0;
    for (int i = 0; i < run.count; ++i)
      if ((changes[run.place + i] & (kStale | kLeft)) != 0) places[count++] = i;
    for (int i = 0; i < count; ++i) {
      prefetch_contacts(w, i, count, [&](int k) { return run.first[places[k]].contact; });
      std::uint8_t& change = changes[run.place + places[i]];
      change = static_cast<std::uint8_t>(look_again(w, block, run.first[places[i]], change, dt, h));
      any[block - near_blocks] |= change;
    }
  };
  const auto settle = [&](int block) {
    if ((any[block] & kRenewed) != 0) settle_impulses(w, runs[block], dt);
  };
  const int run_count = static_cast<int>(runs.size());
  const Crew::Alone alone(w.crew, w.has_rules());
  w.crew.session([&] {
    w.crew.blocks(run_count, carry);
    w.crew.blocks(blocks, update);
    w.crew.blocks(run_count, settle);
  });
}

// After an exception, makes the next step recompute the points of the contacts.
template <class Real>
void invalidate_all(WorldData<Real>& w) {
  for (const ContactRun<Real>& run : w.scratch.contact_runs) {
    for (int i = 0; i < run.count; ++i) {
      ContactConstraint<Real>& c = run.first[i];
      if ((w.scratch.contact_changes[run.place + i] & kRenewed) != 0)
        c.normal_impulse[0] = c.now[0], c.normal_impulse[1] = c.now[1];
      c.recycle_budget = -1;
    }
  }
}

// Asks the user's hook about contacts with new points, on the calling thread and in their order.
template <class Real>
void ask_hook(WorldData<Real>& w, Real dt) {
  if (!w.pre_solve) return;
  w.scratch.begun_contacts.for_each([&](BegunContact<Real>& begun) {
    if (!begun.asked) return;
    begun.waived = !w.pre_solve(begun.constraint.contact, begun.constraint);
    if (!begun.waived) begun.bounces = begin_step(w, begun.constraint, dt);
  });
  for (const ContactRun<Real>& run : w.scratch.contact_runs) {
    for (int i = 0; i < run.count; ++i) {
      std::uint8_t& change = w.scratch.contact_changes[run.place + i];
      if ((change & kAsked) == 0) continue;
      ContactConstraint<Real>& c = run.first[i];
      if (!w.pre_solve(c.contact, c)) {
        change |= kEnded;
      } else if (begin_step(w, c, dt)) {
        change |= kBounces;
      }
    }
  }
}

// Collects the recorded changes, in the order of the contacts.
template <class Real>
void collect_changes(WorldData<Real>& w) {
  Scratch<Real>& scratch = w.scratch;
  scratch.begun_contacts.for_each([&](const BegunContact<Real>& begun) {
    if (begun.waived) return;
    const ContactConstraint<Real>& c = begun.constraint;
    if (begun.bounces) append(scratch.bouncing, c.contact);
    if (begun.pressing) note_pressed(w, c.body_a, c.body_b);
  });
  scratch.found_presses.for_each(
      [&](const std::pair<int, int>& bodies) { note_pressed(w, bodies.first, bodies.second); });
  scratch.found_impacts.for_each(
      [&](const ExpectedImpact<Real>& impact) { append(scratch.expected_impacts, impact); });
  const std::vector<std::uint8_t>& changes = scratch.contact_changes;
  for (std::size_t i = 0; i < w.near.size(); ++i) {
    if ((changes[i] & kLost) != 0) append(scratch.lost_contacts, w.near[i]);
    if ((changes[i] & kTouchChange) != 0) append(scratch.parted_contacts, w.near[i]);
  }
  constexpr int kNoted = kTouchChange | kLost | kEnded | kBounces;
  for (std::size_t block = 0; block < scratch.contact_runs.size(); ++block) {
    const ContactRun<Real>& run = scratch.contact_runs[block];
    // Rebuilt contacts may bounce, too.
    if ((scratch.block_firsts[block] & (kNoted | kRenewed)) == 0) continue;
    for (int i = 0; i < run.count; ++i) {
      const int change = changes[run.place + i];
      if ((change & kNoted) == 0) continue;
      const int id = run.first[i].contact;
      if ((change & kTouchChange) != 0) append(scratch.touch_changes, id);
      if ((change & kLost) != 0) append(scratch.lost_contacts, id);
      if ((change & kEnded) != 0) append(scratch.ended_contacts, id);
      if ((change & kBounces) != 0) append(scratch.bouncing, id);
    }
  }
}

// Leaves predicted impacts that do not happen in free flight to the solver.
template <class Real>
void settle_expected_impacts(WorldData<Real>& w, Real dt) {
  decide_expected_impacts(w, dt);
  w.scratch.left_impacts.clear();
  for (ExpectedImpact<Real>& impact : w.scratch.expected_impacts) {
    ContactConstraint<Real>& c = impact.constraint;
    if (impact.in_graph) {
      if (!impact.left) append(w.scratch.ended_contacts, c.contact);
    } else if (impact.left) {
      if (begin_step(w, c, dt)) append(w.scratch.bouncing, c.contact);
      append(w.scratch.left_impacts, c);
    } else {
      wake_body(w, c.body_a), wake_body(w, c.body_b);
    }
  }
}

// Moves a contact that has got its first points to the graph.
template <class Real>
void enter(WorldData<Real>& w, const ContactConstraint<Real>& c) {
  const int id = c.contact;
  const bool touching = touches(c);
  begin_contact(w, id, c);
  if (touching || w.contacts[id].touching) update_touching(w, constraint_of(w, w.contacts[id]), touching);
}

// Begins the step of contacts whose bodies this update has woken: within the step, an impact may throw a
// sleeping body at a neighbour.
template <class Real>
void begin_unparked(WorldData<Real>& w, Real dt) {
  for (const int id : w.scratch.unparked) {
    if (w.contacts[id].home != ContactHome::Graph) continue;
    if (begin_step(w, constraint_of(w, w.contacts[id]), dt)) append(w.scratch.bouncing, id);
  }
  w.scratch.unparked.clear();
}

}  // namespace

template <class Real>
void update_contacts(WorldData<Real>& w, Real dt, Real h) {
  auto& scratch = w.scratch;
  scratch.lost_contacts.clear(), scratch.ended_contacts.clear(), scratch.touch_changes.clear();
  scratch.bouncing.clear(), scratch.parted_contacts.clear(), scratch.unparked.clear();
  clear_expected_impacts(w);
  if (w.near.empty() && w.graph.empty()) return;
  try {
    update_each(w, dt, h);
    ask_hook(w, dt);
    collect_changes(w);
  } catch (...) {
    invalidate_all(w);
    throw;
  }
  settle_expected_impacts(w, dt);
  for (const int id : scratch.touch_changes) {
    ContactConstraint<Real>& c = constraint_of(w, w.contacts[id]);
    update_touching(w, c, !c.touching);
  }
  for (const int id : scratch.parted_contacts) set_touching(w, id, false);
  for (const int id : scratch.lost_contacts) destroy_contact(w, id);
  for (const int id : scratch.ended_contacts) end_contact(w, id);
  scratch.begun_contacts.for_each([&](const BegunContact<Real>& begun) {
    if (begun.waived) {
      set_touching(w, begun.constraint.contact, false);
    } else {
      enter(w, begun.constraint);
    }
  });
  for (const ContactConstraint<Real>& c : scratch.left_impacts) enter(w, c);
  begin_unparked(w, dt);
}

template <class Real>
void report_impacts(WorldData<Real>& w) {
  const auto struck = [](const ContactConstraint<Real>& c) {
    return c.peak_impulse[0] > 0 || (c.count == 2 && c.peak_impulse[1] > 0);
  };
  for (const int id : w.scratch.bouncing) {
    if (w.contacts[id].home != ContactHome::Graph) continue;
    ContactConstraint<Real>& c = constraint_of(w, w.contacts[id]);
    if (struck(c)) set_touching(w, id, true);
  }
  if (!w.reports_hits) return;
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    const ContactRecord& contact = w.contacts[c.contact];
    if (!contact.hit_events) return;
    const int hardest = c.count == 2 && c.approach[1] < c.approach[0] ? 1 : 0;
    if (c.peak_impulse[hardest] == 0 || c.approach[hardest] > -least_hit_speed(w, c)) return;
    set_touching(w, c.contact, true);
    const ContactReading reading = reading_of(w, contact, c);
    w.log().hits.push_back({reading.shape_a, reading.shape_b, reading.points[hardest], reading.normal,
                            -static_cast<double>(c.approach[hardest]), reading.step_impulse});
  });
}

template void report_impacts(WorldData<float>&);
template void report_impacts(WorldData<double>&);
template void update_contacts(WorldData<float>&, float, float);
template void update_contacts(WorldData<double>&, double, double);

}  // namespace plumb
