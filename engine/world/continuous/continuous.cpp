#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <utility>

#include "engine/core/room.h"
#include "engine/geometry/convex_bounds.h"
#include "engine/world/continuous/joined_stops.h"
#include "engine/world/continuous/rebound.h"
#include "engine/world/continuous/swept_bodies.h"
#include "engine/world/continuous/swept_pair.h"
#include "engine/world/continuous/toi_events.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/step/step.h"

namespace plumb {
namespace {

// Contacts, and swept bodies, per block of a shared loop: at least 10 us of work for a thread.
constexpr int kContactsOfBlock = 512, kSweptOfBlock = 16;

// Prefetches the contacts of the next 8 swept bodies, one of each at a time, because contact
// records are scattered in memory.
class ContactsAhead {
 public:
  ContactsAhead() { edges_.fill(kNone); }

  template <class Real>
  void advance(const WorldData<Real>& w, std::size_t place) {
    const auto ask_for = [&](int edge) {
      if (edge != kNone) __builtin_prefetch(&w.contacts[edge / 2]);
      return edge;
    };
    for (int& edge : edges_)
      if (edge != kNone) edge = ask_for(w.contacts[edge / 2].next[edge & 1]);
    const std::size_t coming = place + edges_.size();
    if (coming < w.scratch.swept_bodies.size())
      edges_[place % edges_.size()] = ask_for(w.bodies[w.scratch.swept_bodies[coming].body].first_contact);
  }

 private:
  std::array<int, 8> edges_;
};

// Orders a heap with the earliest time of impact on top. No two entries are equal.
bool is_later(const ToiEvent& a, const ToiEvent& b) {
  return a.fraction != b.fraction ? a.fraction > b.fraction
                                  : (a.flight != b.flight ? a.flight > b.flight : a.version > b.version);
}

template <class Real>
void expect(WorldData<Real>& w, const ToiEvent& meeting) {
  if (!(meeting.fraction < 1)) return;
  w.scratch.toi_events.push_back(meeting);
  std::push_heap(w.scratch.toi_events.begin(), w.scratch.toi_events.end(), is_later);
}

template <class Real>
void look_ahead(WorldData<Real>& w, int place, double from, ImpactSearch& search) {
  expect(w, first_toi_event(w, place, from, search));
}

// Returns the flight of the body that is hit, or null if the body is static.
template <class Real>
SweptBody* flight_met(WorldData<Real>& w, int body, double dt) {
  if (w.bodies[body].type == BodyType::Static) return nullptr;
  return &w.scratch.swept_bodies[flight_place(w, body, dt)];
}

// Searches impacts of other fast bodies with this one, whose trajectory has changed from a fraction of the
// step on.
template <class Real>
void look_back(WorldData<Real>& w, int place, double from, ImpactSearch& search) {
  const SweptBody flight = w.scratch.swept_bodies[place];
  const Rotation<double> q = flight.rotation_at(from);
  const Pose<Real> pose{flight.start_at(from).template as<Real>(),
                        {static_cast<Real>(q.c), static_cast<Real>(q.s)}};
  std::vector<std::pair<int, int>>& pairs = w.scratch.found_pairs;
  pairs.clear();
  for (int shape = w.bodies[flight.body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const std::uint32_t mask = seen_by(w.shapes[shape].filter);
    if (w.shapes[shape].proxy == kNone || w.forms[shape].sensor || mask == 0) continue;
    w.dynamic_tree.query(convex_bounds(w.convex(shape), pose), mask, [&](int other, int) {
      if (flight_in(w, w.shapes[other].body) != nullptr && may_meet(w, shape, other))
        pairs.emplace_back(shape, other);
      return true;
    });
  }
  for (const auto& [shape, other] : pairs) {
    const int other_place = w.scratch.swept_body_places[w.shapes[other].body];
    const SweptBody& comer = w.scratch.swept_bodies[other_place];
    if (comer.stands || go_together(w, flight, comer.body) || comer.carrier == flight.body) continue;
    // A kinematic body is not stopped, but pushes this one along.
    const bool pushes = !w.is_dynamic(comer.body);
    if (pushes && (flight.carrier != kNone || !w.is_dynamic(flight.body))) continue;
    const Way way(pushes ? w.scratch.swept_bodies[place] : comer, from, search);
    const int moving = pushes ? shape : other, met = pushes ? other : shape;
    ToiEvent found{.flight = pushes ? place : other_place, .version = way.flight.version};
    push_toi_event(w, way, {moving, met, nullptr, !pushes}, found);
    expect(w, as_it_is(w, found));
  }
}

// Calls visit(place) for the swept bodies of a body and of all dynamic bodies connected to it by joints.
template <class Real, class Visit>
void for_each_tied(WorldData<Real>& w, int place, double dt, const Visit& visit) {
  std::vector<int>& queue = w.scratch.queue;
  std::vector<char>& seen = w.scratch.cannot_sleep;
  const int body = w.scratch.swept_bodies[place].body;
  if (w.bodies[body].first_joint == kNone) return visit(place);
  queue.assign(1, body);
  seen.assign(w.bodies.size(), 0);
  seen[body] = 1;
  for (std::size_t next = 0; next < queue.size(); ++next) {
    visit(flight_place(w, queue[next], dt));
    for_each_edge(w.joints, w.bodies[queue[next]].first_joint, [&](int edge, const JointRecord& joint) {
      const int other = (edge & 1) == 0 ? joint.body_b : joint.body_a;
      if (!joint.active || !w.is_dynamic(other) || seen[other]) return;
      seen[other] = 1;
      queue.push_back(other);
    });
  }
  queue.clear();
}

// Stops a body and all bodies connected to it by joints, so that the joints stay closed. Bodies that have to
// move for that do so along the rest of their paths, where other impacts may stop them.
template <class Real>
void stop_island(WorldData<Real>& w, int place, double fraction, ImpactSearch& search) {
  std::vector<int>& stopped = w.scratch.stopped;
  stopped.clear();
  for_each_tied(w, place, search.dt, [&](int tied) {
    if (!w.scratch.swept_bodies[tied].stands) append(stopped, tied);
  });
  take_unmoved_work(w, stopped, fraction, search.dt);
  find_shifts(w, stopped, fraction);
  for_each_tied(w, place, search.dt, [&](int tied) {
    SweptBody& flight = w.scratch.swept_bodies[tied];
    if (flight.stands) return;
    flight.squeezed = flight.carrier != kNone;
    const Vec2d shift = flight.shift;
    flight.stop(fraction);
    if (shift != Vec2d{}) {
      flight.go_on_lifted(fraction, shift);
      insert_swept_aabb(w, flight);
      look_ahead(w, tied, fraction, search);
    }
    look_back(w, tied, fraction, search);
  });
}

// Lets a kinematic body push a body along, with all bodies connected to that by joints.
template <class Real>
void push_along(WorldData<Real>& w, int place, int pusher, double fraction, ImpactSearch& search) {
  for_each_tied(w, place, search.dt, [&](int tied) {
    SweptBody& flight = w.scratch.swept_bodies[tied];
    if (flight.carrier != kNone) return;
    flight.go_along(w.scratch.swept_bodies[pusher], fraction, w.bodies[flight.body].locks());
    insert_swept_aabb(w, flight);
    look_ahead(w, tied, fraction, search);
    look_back(w, tied, fraction, search);
  });
}

// Lifts a body off a surface that it rests on, instead of stopping it there. Returns false if lifting is not
// allowed.
template <class Real>
bool lift(WorldData<Real>& w, const ToiEvent& next, ImpactSearch& search) {
  SweptBody& flight = w.scratch.swept_bodies[next.flight];
  if (flight.impacts > 0 || (flight.changed && flight.lifts == 0)) return false;
  const SweptPair<Real> pair{next.shape, next.other, constraint_between(w, next.shape, next.other)};
  const Way way(flight, next.fraction, search);
  const std::optional<Vec2d> by = lift_off(w, way, pair);
  if (!by || *by == Vec2d{}) return false;
  flight.go_on_lifted(next.fraction, *by);
  insert_swept_aabb(w, flight);
  look_ahead(w, next.flight, next.fraction, search);
  look_back(w, next.flight, next.fraction, search);
  return true;
}

// Processes the next impact. A stale one, of a body whose trajectory has changed since it was found, is
// dropped or searched again.
template <class Real>
void meet(WorldData<Real>& w, const ToiEvent& next, ImpactSearch& search) {
  std::vector<SweptBody>& swept_bodies = w.scratch.swept_bodies;
  if (swept_bodies[next.flight].version != next.version) return;
  const int other_body = w.shapes[next.other].body;
  SweptBody* other = flight_met(w, other_body, search.dt);
  SweptBody& flight = swept_bodies[next.flight];
  if (other != nullptr && other->version != next.other_version) {
    look_ahead(w, next.flight, next.fraction, search);
    return;
  }
  const int other_place = other == nullptr ? kNone : w.scratch.swept_body_places[other_body];
  const Real restitution = restitution_between(w, next.shape, next.other);
  const int most = restitution == 1  ? tuning::kImpactsInFlight
                   : restitution > 0 ? tuning::kBouncesInFlight + tuning::kLandingsInFlight
                                     : tuning::kLandingsInFlight;
  if (flight.yields && flight.impacts < most && may_rebound(w, next.shape, next.other, search.dt)) {
    const bool is_last = flight.impacts + 1 == most;
    const bool thrown = rebound(w, flight, next.shape, other, next.other, next.fraction, search.dt, is_last);
    if (!thrown || is_last) flight.yields = false;  // the bodies do not approach, or they slide on
    if (thrown) insert_swept_aabb(w, flight);
    const bool other_too = thrown && other != nullptr && w.is_dynamic(other->body);
    if (other_too) insert_swept_aabb(w, *other);
    look_ahead(w, next.flight, next.fraction, search);
    if (other_too) look_ahead(w, other_place, next.fraction, search);
    if (thrown) look_back(w, next.flight, next.fraction, search);
    if (other_too) look_back(w, other_place, next.fraction, search);
    return;
  }
  const bool pushed = other != nullptr && !w.is_dynamic(other_body);
  if (pushed && flight.carrier == kNone) {
    push_along(w, next.flight, other_place, next.fraction, search);
    return;
  }
  if (lift(w, next, search)) return;
  const int carrier = flight.carrier;
  if (carrier != kNone && other != nullptr && !pushed && other->carrier == kNone && !other->squeezed) {
    // The pushed body pushes the other one along too.
    push_along(w, other_place, w.scratch.swept_body_places[carrier], next.fraction, search);
    look_ahead(w, next.flight, next.fraction, search);
    return;
  }
  // The other body waits too, otherwise it would push this one further.
  const bool too_many = flight.impacts >= tuning::kImpactsInFlight && other != nullptr && !pushed;
  if (too_many) stop_island(w, other_place, next.fraction, search);
  stop_island(w, next.flight, next.fraction, search);
}

// Processes impacts in the order of time until the step ends.
template <class Real>
void process_toi_queue(WorldData<Real>& w, ImpactSearch& search) {
  std::vector<ToiEvent>& toi_events = w.scratch.toi_events;
  // Reserve for four bodies with the maximum number of impacts per step, so that the list seldom grows.
  ensure_room(toi_events, 4 * tuning::kImpactsInFlight);
  std::make_heap(toi_events.begin(), toi_events.end(), is_later);
  while (!toi_events.empty()) {
    std::pop_heap(toi_events.begin(), toi_events.end(), is_later);
    const ToiEvent next = toi_events.back();
    toi_events.pop_back();
    meet(w, next, search);
  }
}

// Finds impacts of dynamic bodies, even slow ones, with a fast kinematic body that passes them.
template <class Real>
void meet_pushers(WorldData<Real>& w, int place, ImpactSearch& search) {
  const SweptBody pusher = w.scratch.swept_bodies[place];
  const auto note = [&](int shape, int other, const ContactConstraint<Real>* contact) {
    const int body = w.shapes[shape].body;
    if (!FastPassing<Real>(w, body).passes(pusher.body)) return;
    const int met = flight_place(w, body, search.dt);
    const Way way(w.scratch.swept_bodies[met], 0, search);
    ToiEvent found{.flight = met, .version = way.flight.version};
    push_toi_event(w, way, {shape, other, contact}, found);
    if (found.fraction < 1) w.scratch.toi_events.push_back(as_it_is(w, found));
  };
  if (pusher.covered) {
    for_each_edge(w.contacts, w.bodies[pusher.body].first_contact,
                  [&](int edge, const ContactRecord& contact) {
                    const bool is_a = (edge & 1) == 0;
                    note(is_a ? contact.shape_b : contact.shape_a, is_a ? contact.shape_a : contact.shape_b,
                         constraint_in(w, contact));
                  });
    return;
  }
  std::vector<std::pair<int, int>>& pairs = w.scratch.found_pairs;
  pairs.clear();
  const Aabb<Real> swept = way_of(w, pusher);
  for (int shape = w.bodies[pusher.body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const std::uint32_t mask = seen_by(w.shapes[shape].filter);
    if (w.shapes[shape].proxy == kNone || w.forms[shape].sensor || mask == 0) continue;
    w.dynamic_tree.query(swept, mask, [&](int other, int) {
      if (may_meet(w, shape, other)) pairs.emplace_back(other, shape);
      return true;
    });
  }
  for (const auto& [shape, other] : pairs) note(shape, other, constraint_between(w, shape, other));
}

// Marks the bodies that contacts have pressed in this step, and those that a contact may hold.
template <class Real>
void find_loaded_bodies(WorldData<Real>& w) {
  w.scratch.loaded.assign(w.bodies.size(), 0);
  w.graph.for_each([&](const ContactConstraint<Real>& c) {
    if (has_pressed(c)) return note_loaded(w, c);
    const Real near = c.push_speed * Real(tuning::kRecycleDistance / tuning::kPushSpeed);
    if (c.separation[0] > near && (c.count < 2 || c.separation[1] > near)) return;
    for (const int body : {c.body_a, c.body_b})
      if (w.scratch.loaded[body] == 0) w.scratch.loaded[body] = kMayHold;
  });
}

// Collects contacts so deep that a core is near: they are checked even if their depth grows slowly.
template <class Real>
void find_deep_contacts(WorldData<Real>& w) {
  const auto is_deep = [&](const ContactConstraint<Real>& c) {
    const Real depth = -std::min(c.now[0], c.now[1]);
    if (!(depth > Real(tuning::kDeepFrom / tuning::kPushSpeed) * c.push_speed)) return false;
    const auto half_width = [&](int body) { return w.bodies[body].half_width; };
    const bool a_yields = w.is_dynamic(c.body_a), b_yields = w.is_dynamic(c.body_b);
    const Real limit =
        (a_yields ? half_width(c.body_a) : Real(0)) + (b_yields ? half_width(c.body_b) : Real(0));
    return depth > Real(0.5 * tuning::kCoreDepth) * limit;
  };
  if (!w.crew.shares()) {
    w.graph.for_each([&](const ContactConstraint<Real>& c) {
      if (is_deep(c)) w.scratch.deep_contacts.push_back(c.contact);
    });
    return;
  }
  std::vector<ContactRun<Real>>& runs = w.scratch.contact_runs;
  runs.clear();
  w.graph.for_each_colour([&](std::vector<ContactConstraint<Real>>& colour, bool) {
    const int count = static_cast<int>(colour.size());
    for (int first = 0; first < count; first += kContactsOfBlock)
      append(runs, ContactRun<Real>{colour.data() + first, std::min(kContactsOfBlock, count - first), 0});
  });
  w.scratch.found_deep.begin(static_cast<int>(runs.size()));
  w.crew.blocks(static_cast<int>(runs.size()), [&](int block) {
    const ContactRun<Real>& run = runs[block];
    for (int i = 0; i < run.count; ++i)
      if (is_deep(run.first[i])) w.scratch.found_deep.add(block, run.first[i].contact);
  });
  w.scratch.found_deep.for_each([&](int contact) { append(w.scratch.deep_contacts, contact); });
}

// Finds the first impacts of the dynamic bodies among the first `count` swept ones. Each block may use the
// whole budget of iterations. Returns false as soon as all blocks together have used more.
template <class Real>
bool find_first_impacts(WorldData<Real>& w, int count, ImpactSearch& search) {
  const int blocks = (count + kSweptOfBlock - 1) / kSweptOfBlock;
  std::atomic<std::int64_t> taken{0};
  w.scratch.found_toi_events.begin(blocks);
  w.crew.blocks(blocks, [&](int block) {
    ContactsAhead ahead;
    for (int i = block * kSweptOfBlock; i < std::min(count, (block + 1) * kSweptOfBlock); ++i) {
      ahead.advance(w, static_cast<std::size_t>(i));
      if (!w.is_dynamic(w.scratch.swept_bodies[i].body)) continue;
      if (taken.load(std::memory_order_relaxed) > search.toi_iteration_budget) return;
      ImpactSearch own = search;
      const ToiEvent first = first_toi_event(w, i, 0, own);
      if (first.fraction < 1) w.scratch.found_toi_events.add(block, first);
      const int iterations = search.toi_iteration_budget - own.toi_iteration_budget;
      if (iterations > 0) taken.fetch_add(iterations, std::memory_order_relaxed);
    }
  });
  if (taken.load() > search.toi_iteration_budget) return false;
  search.toi_iteration_budget -= static_cast<int>(taken.load());
  w.scratch.found_toi_events.for_each([&](const ToiEvent& first) { append(w.scratch.toi_events, first); });
  return true;
}

// Stores the swept AABBs of bodies whose fat AABB was updated at the end of their motion and does not contain
// the whole path.
template <class Real>
void show_ways(WorldData<Real>& w) {
  for (SweptBody& flight : w.scratch.swept_bodies)
    if (!flight.shown && w.enlarged[flight.body]) insert_swept_aabb(w, flight);
}

template <class Real>
void meet_deep_contacts(WorldData<Real>& w, ImpactSearch& search) {
  for (const int id : w.scratch.deep_contacts) {
    const ContactRecord& contact = w.contacts[id];
    const auto half_width = [&](int body) { return w.bodies[body].half_width; };
    const bool is_a =
        w.is_dynamic(contact.body_a) &&
        (!w.is_dynamic(contact.body_b) || half_width(contact.body_a) < half_width(contact.body_b));
    const int met = flight_place(w, is_a ? contact.body_a : contact.body_b, search.dt);
    const Way way(w.scratch.swept_bodies[met], 0, search);
    ToiEvent found{.flight = met, .version = way.flight.version};
    const int shape = is_a ? contact.shape_a : contact.shape_b,
              other = is_a ? contact.shape_b : contact.shape_a;
    push_toi_event(w, way, {shape, other, constraint_in(w, contact)}, found);
    if (found.fraction < 1) w.scratch.toi_events.push_back(as_it_is(w, found));
  }
}

// Adds the flights of the fast bodies. Returns true if the fat AABBs of all of them contained their motions.
template <class Real>
bool add_fast_bodies(WorldData<Real>& w, double dt) {
  std::vector<SweptBody>& swept_bodies = w.scratch.swept_bodies;
  bool all_covered = true;
  for (const FastBody& fast : w.scratch.fast_bodies) {
    if (!(w.settings.continuous && w.extras_of(fast.body).continuous) && !fast.expected) continue;
    all_covered = all_covered && fast.covered;
    if (!w.crew.shares()) {
      SweptBody& flight = swept_bodies[flight_place(w, fast.body, dt)];
      flight.covered = fast.covered, flight.expected = fast.expected;
      continue;
    }
    w.scratch.swept_body_places[fast.body] = static_cast<int>(swept_bodies.size());
    SweptBody flight;
    flight.body = fast.body, flight.covered = fast.covered, flight.expected = fast.expected;
    append(swept_bodies, flight);
  }
  if (!w.crew.shares()) return all_covered;
  w.crew.ranges(static_cast<int>(swept_bodies.size()), kSweptOfBlock, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const SweptBody fast = swept_bodies[i];
      swept_bodies[i] = flight_of(w, fast.body, dt);
      set_arm(w, swept_bodies[i]);
      swept_bodies[i].covered = fast.covered, swept_bodies[i].expected = fast.expected;
    }
  });
  return all_covered;
}

}  // namespace

template <class Real>
void solve_continuous(WorldData<Real>& w, Real dt) {
  w.scratch.deep_contacts.clear();
  if (w.settings.continuous) find_deep_contacts(w);
  if (w.scratch.fast_bodies.empty() && w.scratch.deep_contacts.empty()) return;
  find_loaded_bodies(w);
  const double time = static_cast<double>(dt);
  std::vector<SweptBody>& swept_bodies = w.scratch.swept_bodies;
  swept_bodies.clear(), w.scratch.toi_events.clear();
  w.scratch.swept_body_places.assign(w.bodies.size(), kNone);
  const bool all_covered = add_fast_bodies(w, time);
  for (SweptBody& flight : swept_bodies)
    if (!flight.covered) insert_swept_aabb(w, flight);
  if (!all_covered) show_ways(w);
  // All impacts are found before any body is moved, so that two fast bodies see each other's whole motion.
  ImpactSearch search{.dt = time, .toi_iteration_budget = tuning::kToiIterationBudget};
  const int fast_count = static_cast<int>(swept_bodies.size());
  if (!w.crew.shares() || !find_first_impacts(w, fast_count, search)) {
    // Each search gets the part of the budget that earlier searches have left.
    ContactsAhead ahead;
    for (int i = 0; i < fast_count; ++i) {
      ahead.advance(w, static_cast<std::size_t>(i));
      const ToiEvent first = first_toi_event(w, i, 0, search);
      if (first.fraction < 1) append(w.scratch.toi_events, first);
    }
  }
  for (int i = 0; i < fast_count; ++i)
    if (!w.is_dynamic(swept_bodies[i].body)) meet_pushers(w, i, search);
  meet_deep_contacts(w, search);
  if (!w.scratch.toi_events.empty()) {
    show_ways(w);
    process_toi_queue(w, search);
  }
  for (const SweptBody& flight : swept_bodies) {
    if (flight.changed) {
      land(w, flight);
      for (int shape = w.bodies[flight.body].first_shape; shape != kNone; shape = w.shapes[shape].next)
        update_proxy(w, shape, dt, Real(0));
    }
    if (flight.shown) restore_fat_aabb(w, flight.body, dt);
  }
  w.scratch.swept_body_places.clear();
}

template void solve_continuous(WorldData<float>&, float);
template void solve_continuous(WorldData<double>&, double);

}  // namespace plumb
