#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "engine/collide/time_of_impact.h"
#include "engine/geometry/convex_bounds.h"
#include "engine/world/constants.h"
#include "engine/world/contacts.h"
#include "engine/world/rebound.h"
#include "engine/world/step.h"

namespace plumb {
namespace {

// A shape shrunk towards its middle. While the core of a body has passed nothing, contacts push it out again
// on the side that it came from; so a body is only stopped on its way when its core would get through.
template <class Real>
struct Core {
  Core(const Convex<Real>& shape, Real share) {
    Vec2<Real> middle{};
    for (int i = 0; i < shape.count; ++i) middle += shape.corners[i].point;
    middle *= Real(1) / static_cast<Real>(shape.count);
    for (int i = 0; i < shape.count; ++i) {
      const Corner<Real>& from = shape.corners[i];
      std::construct_at(corners + i, Corner<Real>{middle + share * (from.point - middle), from.normal});
    }
    convex = {corners, shape.count, share * shape.radius};
  }
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;
  union {
    Corner<Real> corners[kMaxCorners];  // the first `convex.count` alone are made
  };
  Convex<Real> convex;
};

// What is left of a body's motion at a fraction of this step, seen from `origin`. The rotation is that of the
// step's end, turned back.
template <class Real>
Sweep<double> sweep_of(const WorldData<Real>& w, int body, double from, Vec2d origin, double dt) {
  if (const Flight* flight = flight_in(w, body)) return flight->sweep(from, origin);
  return flight_of(w, body, dt).sweep(from, origin);
}

template <class Real>
bool in_front(const WorldData<Real>& w, int chain_segment, Vec2d point, const Sweep<double>& chain) {
  const Convex<Real> segment = w.convex(chain_segment);
  const Vec2d local = chain.start_rotation.inverse() * (point - chain.start);
  const Corner<Real>& first = segment.corners[0];
  return dot(first.normal.template as<double>(), local - first.point.template as<double>()) >= 0;
}

// Whether two bodies move fast relative to each other: no slower than one could pass through the other.
template <class Real>
bool pass_fast(const WorldData<Real>& w, int a, int b) {
  const Vec2<Real> way = w.motion[b].moved - w.motion[a].moved;
  const Real turned =
      std::abs(w.motion[a].turned) * w.extents[a] + std::abs(w.motion[b].turned) * w.extents[b];
  return std::abs(way.x) + std::abs(way.y) + turned > Real(tuning::kFastShare) * w.bodies[a].half_width;
}

// The rest of a fast body's way, seen from where it starts.
struct Way {
  Way(const Flight& flight_, double from_, double dt_, int& long_searches_)
      : flight(flight_),
        from(from_),
        dt(dt_),
        origin(flight_.start_at(from_)),
        sweep(flight_.sweep(from_, origin)),
        long_searches(long_searches_) {}
  const Flight& flight;
  double from, dt;  // of the step, the latter in s
  Vec2d origin;
  Sweep<double> sweep;
  int& long_searches;  // iterations left to all of the step, see kLongSearches
};

// How much of a shape is its core against another one. Two discs may not even graze each other unseen.
template <class Real>
Real core_share(const WorldData<Real>& w, int shape, int other) {
  const ShapeForm<Real>&a = w.forms[shape], &b = w.forms[other];
  if (a.count != 1 || b.count != 1) return Real(tuning::kCoreShare);
  return 1 - Real(tuning::kGraze) * std::min(b.radius / a.radius, Real(1));
}

// How near a flight is brought to what throws it back, m: as near as roundings can tell.
template <class Real>
Real rebound_tolerance(const WorldData<Real>& w, const Way& way, int other,
                       const Sweep<double>& other_sweep) {
  const auto size = [](Vec2d v) { return std::abs(v.x) + std::abs(v.y); };
  const double bodies = static_cast<double>(w.extents[way.flight.body] + w.extents[w.shapes[other].body]);
  const double ways = size(other_sweep.start) + size(other_sweep.motion) + size(way.sweep.motion) +
                      bodies * (std::abs(way.sweep.turn) + std::abs(other_sweep.turn));
  return static_cast<Real>(tuning::kReboundTolerance * (bodies + ways));
}

// The fraction of the step at which `shape` of a fast body meets `other`; 1 when it does not.
template <class Real>
double fraction_of_impact(const WorldData<Real>& w, const Way& way, int shape, int other) {
  const Sweep<double> other_sweep = sweep_of(w, w.shapes[other].body, way.from, way.origin, way.dt);
  if (w.forms[other].chain && !in_front(w, other, way.sweep.start, other_sweep)) return 1;
  const Convex<Real> whole = w.convex(shape), obstacle = w.convex(other);
  using Result = ImpactResult<Real>;
  const Real smaller = std::min(w.forms[shape].extent, w.forms[other].extent);
  const Real tolerance = Real(tuning::kImpactTolerance) * smaller;
  const auto meet = [&](const Convex<Real>& moving, Real near) {
    const Result found = time_of_impact(obstacle, other_sweep, moving, way.sweep, near, near,
                                        tuning::kImpactIterations + way.long_searches);
    way.long_searches -= std::max(0, found.iterations - tuning::kImpactIterations);
    return found;
  };
  const auto fraction = [&](const Result& result) {
    return way.from + result.exact_fraction * (1 - way.from);
  };
  if (way.flight.yields && may_rebound(w, shape, other)) {
    const Result first = meet(whole, rebound_tolerance(w, way, other, other_sweep));
    if (first.state == Result::State::Separated) return 1;
    if (first.state != Result::State::Overlapped) return fraction(first);
  }
  // No contact pushes out again what flies on, or left its contact to the flight: it stops where it first
  // touches.
  if (way.flight.expected || way.flight.impacts > 0) {
    const Result first = meet(whole, tolerance);
    if (first.state == Result::State::Separated) return 1;
    if (first.state == Result::State::Hit && first.exact_fraction > 0) return fraction(first);
  }
  const Core<Real> core(whole, core_share(w, shape, other));
  const Result through = meet(core.convex, tolerance);
  if (through.state == Result::State::Separated || through.state == Result::State::Overlapped) return 1;
  const Result first = meet(whole, tolerance);
  // Shapes that touched at the start are held by their contact until the core comes too near.
  return first.state == Result::State::Overlapped || first.exact_fraction == 0 ? fraction(through)
                                                                               : fraction(first);
}

// Whether a contact between the shapes had points in this step: the solver has seen to it.
template <class Real>
bool was_solved(const WorldData<Real>& w, int body, int shape, int other) {
  const int other_body = w.shapes[other].body;
  const auto is_solved = [&](const ContactRecord& contact) {
    return contact.home == ContactHome::Graph && ((contact.shape_a == shape && contact.shape_b == other) ||
                                                  (contact.shape_a == other && contact.shape_b == shape));
  };
  return any_between(w.contacts, w.bodies[body].first_contact, w.bodies[other_body].first_contact, body,
                     other_body, is_solved);
}

// A box around all that the body covers for the rest of its way.
template <class Real>
Aabb<Real> way_of(const WorldData<Real>& w, const Flight& flight) {
  const Vec2<Real> start = flight.start.template as<Real>(), end = flight.end().template as<Real>();
  const Real aside = static_cast<Real>(std::abs(flight.curve.x) + std::abs(flight.curve.y));
  return merged(Aabb<Real>{start, start}, Aabb<Real>{end, end}).grown(w.extents[flight.body] + aside);
}

// Takes the sooner one.
template <class Real>
void note_meeting(const WorldData<Real>& w, const Way& way, int shape, int other, Meeting& first) {
  const double fraction = fraction_of_impact(w, way, shape, other);
  if (fraction < first.fraction) first.fraction = fraction, first.shape = shape, first.other = other;
}

// The first of all that the body meets, when all of that has a contact with it.
template <class Real>
void meet_pairs(const WorldData<Real>& w, const Way& way, Meeting& first) {
  const int body = way.flight.body;
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, const ContactRecord& contact) {
    if (contact.home == ContactHome::Graph) return;  // the solver has seen to it
    const bool is_a = (edge & 1) == 0;
    if (!way.flight.expected && !pass_fast(w, body, is_a ? contact.body_b : contact.body_a)) return;
    const int shape = is_a ? contact.shape_a : contact.shape_b,
              other = is_a ? contact.shape_b : contact.shape_a;
    if (!w.forms[shape].chain) note_meeting(w, way, shape, other, first);
  });
}

// The first of all that the body meets. What it flies on to after an impact, no solver has seen to.
template <class Real>
void meet_all(const WorldData<Real>& w, const Way& way, Meeting& first) {
  const int body = way.flight.body;
  const bool flies_on = way.flight.impacts > 0, near = way.flight.expected || flies_on;
  const Aabb<Real> swept = way_of(w, way.flight);
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const std::uint32_t mask = seen_by(w.shapes[shape].filter);
    if (w.forms[shape].sensor || w.forms[shape].chain || mask == 0) continue;
    const auto visit = [&](int other, int) {
      if (!may_collide(w, shape, other)) return true;
      if (!near && !pass_fast(w, body, w.shapes[other].body)) return true;
      if (!flies_on && was_solved(w, body, shape, other)) return true;
      note_meeting(w, way, shape, other, first);
      return true;
    };
    w.still_tree.query(swept, mask, visit);
    w.moving_tree.query(swept, mask, visit);
  }
}

// The contacts of a body lie anywhere in memory: those of the flights to come are asked for in time, one of
// each flight's at a time.
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
    if (coming < w.scratch.flights.size())
      edges_[place % edges_.size()] = ask_for(w.bodies[w.scratch.flights[coming].body].first_contact);
  }

 private:
  std::array<int, 8> edges_;
};

// What a flight meets first from a fraction of the step on.
template <class Real>
Meeting first_meeting(const WorldData<Real>& w, int place, double from, double dt, int& long_searches) {
  const Flight& flight = w.scratch.flights[place];
  Meeting first{.flight = place, .version = flight.version};
  if (!w.gives_way(flight.body)) return first;
  const Way way(flight, from, dt, long_searches);
  if (flight.covered && flight.impacts == 0) {
    meet_pairs(w, way, first);
  } else {
    meet_all(w, way, first);
  }
  if (first.other == kNone) return first;
  if (const Flight* other = flight_in(w, w.shapes[first.other].body)) first.other_version = other->version;
  return first;
}

// Stores the whole way of a fast body, so that others find it.
template <class Real>
void show_way(WorldData<Real>& w, const Flight& flight) {
  const int body = flight.body;
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (w.shapes[shape].proxy == kNone) continue;
    DynamicTree<Real>& tree = w.tree_of(w.bodies[body].type);
    tree.enlarge(w.shapes[shape].proxy, merged(way_of(w, flight), tree.box(w.shapes[shape].proxy)));
  }
}

// Stores what is needed from here on again.
template <class Real>
void hide_way(WorldData<Real>& w, int body, Real dt) {
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (w.shapes[shape].proxy == kNone) continue;
    w.tree_of(w.bodies[body].type).enlarge(w.shapes[shape].proxy, stored_box(w, shape, dt));
    w.enlarged[body] = 1;
    if (!w.shapes[shape].moved) append(w.moved_shapes, shape);
    w.shapes[shape].moved = true;
  }
}

// The later one first, as heaps have it; none is the same as another.
bool is_later(const Meeting& a, const Meeting& b) {
  return a.fraction != b.fraction ? a.fraction > b.fraction
                                  : (a.flight != b.flight ? a.flight > b.flight : a.version > b.version);
}

template <class Real>
void look_ahead(WorldData<Real>& w, int place, double from, double dt, int& long_searches) {
  const Meeting next = first_meeting(w, place, from, dt, long_searches);
  if (!(next.fraction < 1)) return;
  w.scratch.meetings.push_back(next);
  std::push_heap(w.scratch.meetings.begin(), w.scratch.meetings.end(), is_later);
}

// The flight of what is met; null when that does not move.
template <class Real>
Flight* flight_met(WorldData<Real>& w, int body, double dt) {
  if (w.bodies[body].type == BodyType::Static) return nullptr;
  int& place = w.scratch.flight_places[body];
  if (place == kNone) {
    place = static_cast<int>(w.scratch.flights.size());
    w.scratch.flights.push_back(flight_of(w, body, dt));
  }
  return &w.scratch.flights[place];
}

// What was to meet next does so, unless either of both is on another way since.
template <class Real>
void meet(WorldData<Real>& w, const Meeting& next, double dt, int& long_searches) {
  std::vector<Flight>& flights = w.scratch.flights;
  if (flights[next.flight].version != next.version) return;
  Flight* other = flight_met(w, w.shapes[next.other].body, dt);
  Flight& flight = flights[next.flight];
  if (other != nullptr && other->version != next.other_version) {
    look_ahead(w, next.flight, next.fraction, dt, long_searches);
    return;
  }
  if (flight.yields && flight.impacts < tuning::kImpactsInFlight && may_rebound(w, next.shape, next.other)) {
    const bool thrown = rebound(w, flight, next.shape, other, next.other, next.fraction, dt);
    if (!thrown) flight.yields = false;  // they do not approach
    if (thrown) show_way(w, flight);
    const bool other_too = thrown && other != nullptr && w.gives_way(other->body);
    if (other_too) show_way(w, *other);
    look_ahead(w, next.flight, next.fraction, dt, long_searches);
    if (other_too)
      look_ahead(w, w.scratch.flight_places[w.shapes[next.other].body], next.fraction, dt, long_searches);
    return;
  }
  // Whoever pushes it on waits too.
  if (flight.impacts >= tuning::kImpactsInFlight && other != nullptr && w.gives_way(other->body))
    other->stop(next.fraction);
  flight.stop(next.fraction);
}

// One impact after the other, until the step ends.
template <class Real>
void fly_on(WorldData<Real>& w, double dt, int& long_searches) {
  std::vector<Flight>& flights = w.scratch.flights;
  std::vector<Meeting>& meetings = w.scratch.meetings;
  w.scratch.flight_places.assign(w.bodies.size(), kNone);
  for (std::size_t i = 0; i < flights.size(); ++i)
    w.scratch.flight_places[flights[i].body] = static_cast<int>(i);
  std::make_heap(meetings.begin(), meetings.end(), is_later);
  while (!meetings.empty()) {
    std::pop_heap(meetings.begin(), meetings.end(), is_later);
    const Meeting next = meetings.back();
    meetings.pop_back();
    meet(w, next, dt, long_searches);
  }
  w.scratch.flight_places.clear();
}

}  // namespace

template <class Real>
void stop_at_impacts(WorldData<Real>& w, Real dt) {
  if (w.scratch.fast_bodies.empty()) return;
  const double time = static_cast<double>(dt);
  std::vector<Flight>& flights = w.scratch.flights;
  std::vector<Meeting>& meetings = w.scratch.meetings;
  flights.clear(), meetings.clear();
  for (const FastBody& fast : w.scratch.fast_bodies) {
    if (!w.settings.continuous && !fast.expected) continue;
    flights.push_back(flight_of(w, fast.body, time));
    flights.back().covered = fast.covered, flights.back().expected = fast.expected;
    if (!fast.covered) show_way(w, flights.back());
  }
  // All are found before any is moved, so that two fast bodies see each other's whole way.
  bool rebounds = false;
  int long_searches = tuning::kLongSearches;
  ContactsAhead ahead;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    ahead.advance(w, i);
    const Meeting first = first_meeting(w, static_cast<int>(i), 0, time, long_searches);
    if (!(first.fraction < 1)) continue;
    meetings.push_back(first);
    rebounds = rebounds || may_rebound(w, first.shape, first.other);
  }
  if (rebounds) {
    fly_on(w, time, long_searches);
  } else {
    for (const Meeting& at : meetings) flights[at.flight].stop(at.fraction);
  }
  for (const Flight& flight : flights) {
    if (flight.changed) {
      land(w, flight);
      for (int shape = w.bodies[flight.body].first_shape; shape != kNone; shape = w.shapes[shape].next)
        refresh_box(w, shape, dt, Real(0));
    }
    if (!flight.covered || flight.impacts > 0) hide_way(w, flight.body, dt);
  }
}

template void stop_at_impacts(WorldData<float>&, float);
template void stop_at_impacts(WorldData<double>&, double);

}  // namespace plumb
