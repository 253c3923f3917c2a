#include "engine/world/contact_solver/impact_propagation.h"

#include <algorithm>
#include <limits>

#include "engine/core/room.h"
#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/contact_solver/impact_round.h"

namespace plumb {
namespace {

// Impacts closer in time than this fraction of a substep are simultaneous.
constexpr double kAtOnce = 1e-3;
// Approaches below this fraction of the fastest are left to the solver's iterations, which stop them.
constexpr double kSlow = 1e-4;
// Maximum number of contacts examined in all rounds of a substep, and of points solved in all their
// iterations: kLooks and, for rebounds, kLooksToRebound times the largest e of the crowd; with e = 1 about 2
// ms. Impacts beyond it are left to the constraints, which lose their rebounds: the fraction e of an
// approach. A stirred heap of 6000 bodies with e = 0.1 reaches it in its first round. With six times as many
// its overlaps are smaller by 3 % (0.107 m in place of 0.11 m), and as many bodies escape.
constexpr int kLooks = 1 << 12, kLooksToRebound = 1 << 16;
// Maximum number of rounds of a substep in which no time passes, plus as many for each contact of the group.
// An impact passes to the far end and back in a few rounds. More are needed only if friction or a second wall
// presses a body back at once.
constexpr int kAtOneTime = 64, kAtOneTimeEach = 8;

// Returns the present separation of a point, m.
template <class Real>
Real separation_of(const BodyMotion<Real>* motion, const ContactConstraint<Real>& c, int i) {
  const BodyMotion<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return c.separation[i] + dot(c.normal, b.moved - a.moved) + (c.arm_b[i] * b.turned - c.arm_a[i] * a.turned);
}

template <class Real>
Real nearest_point(const ContactConstraint<Real>& c) {
  return c.count == 2 ? std::min(c.now[0], c.now[1]) : c.now[0];
}

template <class Real>
bool is_struck(const RestitutionContact<Real>& bounce) {
  return bounce.strikes[0] || bounce.strikes[1];
}

// Returns the fastest approach of a point that has an impact, m/s.
template <class Real>
Real fastest_strike(const BodyMotion<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces) {
  Real fastest = 0;
  for (const RestitutionContact<Real>& bounce : bounces) {
    if (!is_struck(bounce)) continue;
    for (int i = 0; i < bounce.contact->count; ++i) {
      if (bounce.strikes[i]) fastest = std::max(fastest, -velocity_along_normal(motion, *bounce.contact, i));
    }
  }
  return fastest;
}

// Time of a point without an impact to come.
template <class Real>
constexpr Real kNever = std::numeric_limits<Real>::infinity();

template <class Real>
void clear_room(const std::vector<RestitutionContact<Real>>& bounces, ImpactScratch<Real>& room) {
  int bodies = static_cast<int>(room.group.size());
  for (const RestitutionContact<Real>& bounce : bounces)
    bodies = std::max({bodies, bounce.contact->body_a + 1, bounce.contact->body_b + 1});
  if (static_cast<int>(room.reached.size()) < bodies) {
    make_room(room.reached, bodies), make_room(room.marked, bodies), make_room(room.earliest, bodies);
    make_room(room.last, bodies), make_room(room.first_contact, bodies), make_room(room.struck_at, bodies);
    make_room(room.struck_now, bodies);
  }
  const int contacts = static_cast<int>(bounces.size());
  if (static_cast<int>(room.in_list.size()) < contacts) {
    make_room(room.in_list, contacts), make_room(room.next, 2 * contacts), make_room(room.coming, contacts);
    const std::size_t points = room.next.size();
    ensure_room(room.struck, points), ensure_room(room.grouped, points);
    ensure_room(room.following, points), ensure_room(room.latest, points);
    ensure_room(room.crowd, room.in_list.size()), ensure_room(room.looked, room.in_list.size());
    ensure_room(room.groups, points);
  }
  for (const RestitutionContact<Real>& bounce : bounces) {
    for (const int body : {bounce.contact->body_a, bounce.contact->body_b}) {
      const int group = group_of(room, body);
      room.reached[group] = room.marked[group] = 0, room.last[group] = 0;
      room.first_contact[group] = room.struck_at[group] = -1;
    }
  }
  for (const int group : room.group) room.reached[group] = 0;
  std::fill_n(room.in_list.begin(), contacts, char(0));
  room.crowd.clear(), room.looked.clear(), room.groups.clear(), room.struck.clear();
}

// Calls visit(contact) for the contacts of a group to which impacts may propagate.
template <class Real, class Visit>
void for_each_at(const ImpactScratch<Real>& room, int group, const Visit& visit) {
  for (int edge = room.first_contact[group]; edge != -1; edge = room.next[edge]) visit(edge / 2);
}

// Marks the contact's bodies as reachable by impact propagation, and lists those that were not before.
template <class Real>
void reach(const BodyMotion<Real>* motion, const ContactConstraint<Real>& c, ImpactScratch<Real>& room) {
  for (const int body : {c.body_a, c.body_b}) {
    const int group = group_of(room, body);
    if (!is_dynamic(motion[body]) || room.reached[group]) continue;
    room.reached[group] = 1;
    room.groups.push_back(group);
  }
}

// Collects the contacts with impacts and all contacts to which these may propagate.
template <class Real>
void find_crowd(const BodyMotion<Real>* motion, std::vector<RestitutionContact<Real>>& bounces, Real within,
                ImpactScratch<Real>& room) {
  clear_room(bounces, room);
  const int contacts = static_cast<int>(bounces.size());
  for (int i = contacts - 1; i >= 0; --i) {
    const ContactConstraint<Real>& c = *bounces[i].contact;
    if (!is_struck(bounces[i]) && !(nearest_point(c) <= within)) continue;
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? c.body_a : c.body_b;
      if (!is_dynamic(motion[body])) continue;
      int& first = room.first_contact[group_of(room, body)];
      room.next[2 * i + side] = first, first = 2 * i + side;
    }
    if (is_struck(bounces[i])) reach(motion, c, room);
  }
  for (std::size_t next = 0; next < room.groups.size(); ++next) {
    for_each_at(room, room.groups[next], [&](int i) {
      room.in_list[i] = 1;
      reach(motion, *bounces[i].contact, room);
    });
  }
  room.groups.clear();
  for (int i = 0; i < contacts; ++i) {
    if (room.in_list[i] == 0) continue;
    room.in_list[i] = 0;
    room.crowd.push_back(i);
  }
}

// Adds an item to a list, unless it is in there. Lists have room for all (`clear_room`).
inline void note(std::vector<int>& list, std::vector<char>& noted, int item) {
  if (noted[item]) return;
  noted[item] = 1;
  list.push_back(item);
}

// Finds the time of the next impact of each point of a contact, for the present motion of its bodies.
template <class Real>
void look_at(const BodyMotion<Real>* motion, RestitutionContact<Real>& bounce, Real least, Real h,
             const ImpactScratch<Real>& room, ComingImpact<Real>& coming) {
  ContactConstraint<Real>& c = *bounce.contact;
  const Real start = std::max(room.last[group_of(room, c.body_a)], room.last[group_of(room, c.body_b)]);
  if (bounce.radii != 0) face(motion, bounce, h, std::min(start, h));
  for (int i = 0; i < 2; ++i) {
    coming.time[i] = kNever<Real>;
    if (i >= c.count) continue;
    const Real closing = -velocity_along_normal(motion, c, i);
    const Real s = std::max(separation_of(motion, c, i), Real(0));
    if (!(closing > least) || s > closing * h) continue;
    // A point without an earlier impact bounces as `schedule_impacts` set it, with the effect of gravity
    // before and after.
    const bool placed = start == 0 && bounce.strikes[i];
    coming.time[i] = std::max(s / closing, start);
    coming.wanted[i] = placed ? bounce.speed[i] : c.restitution * closing;
    coming.before[i] = -closing;
  }
}

// Prefetches the contacts of a list and, once these are loaded, their bodies: they are scattered in memory.
// Always inlined, because GCC 12 drops calls of a function that only prefetches.
template <class Real>
[[gnu::always_inline]] inline void prefetch_listed(const BodyMotion<Real>* motion,
                                                   const std::vector<RestitutionContact<Real>>& bounces,
                                                   const std::vector<int>& list, std::size_t i) {
  constexpr std::size_t kBounces = 12, kContacts = 8, kBodies = 4;
  if (i + kBounces < list.size()) __builtin_prefetch(&bounces[list[i + kBounces]]);
  if (i + kContacts < list.size()) {
    const char* const contact = reinterpret_cast<const char*>(bounces[list[i + kContacts]].contact);
    for (std::size_t byte = 0; byte < sizeof(ContactConstraint<Real>); byte += 64)
      __builtin_prefetch(contact + byte);
  }
  if (i + kBodies >= list.size()) return;
  const ContactConstraint<Real>& c = *bounces[list[i + kBodies]].contact;
  __builtin_prefetch(&motion[c.body_a]), __builtin_prefetch(&motion[c.body_b]);
}

// Brings the contacts of a list, all of the crowd and marked, into the order of the crowd. Clears the marks.
template <class Real>
void arrange_looked(ImpactScratch<Real>& room) {
  constexpr std::size_t kSorted = 16;  // a list of fewer than one in so many is sorted by itself
  if (kSorted * room.looked.size() < room.crowd.size()) {
    std::sort(room.looked.begin(), room.looked.end());
    for (const int i : room.looked) room.in_list[i] = 0;
    return;
  }
  room.looked.clear();
  for (const int i : room.crowd) {
    if (room.in_list[i] == 0) continue;
    room.in_list[i] = 0;
    room.looked.push_back(i);
  }
}

// Finds the points of the next impacts: for each body those of its earliest one. Examines only the listed
// contacts, whose bodies have had an impact since they were last examined; the predictions for the others
// have not changed.
template <class Real>
void find_struck(const BodyMotion<Real>* motion, std::vector<RestitutionContact<Real>>& bounces, Real least,
                 Real h, ImpactScratch<Real>& room) {
  room.struck.clear(), room.groups.clear();
  for (std::size_t k = 0; k < room.looked.size(); ++k) {
    prefetch_listed(motion, bounces, room.looked, k);
    const int i = room.looked[k];
    room.in_list[i] = 0;
    look_at(motion, bounces[i], least, h, room, room.coming[i]);
    for (const int body : {bounces[i].contact->body_a, bounces[i].contact->body_b})
      if (is_dynamic(motion[body])) note(room.groups, room.marked, group_of(room, body));
  }
  room.looked.clear();
  for (const int group : room.groups) {
    Real earliest = kNever<Real>;
    for_each_at(room, group, [&](int i) {
      const Real(&time)[2] = room.coming[i].time;
      earliest = std::min(earliest, std::min(time[0], time[1]));
      note(room.looked, room.in_list, i);
    });
    room.earliest[group] = earliest;
    room.marked[group] = 0;
  }
  arrange_looked(room);
  for (const int i : room.looked) {
    const ComingImpact<Real>& coming = room.coming[i];
    if (coming.time[0] == kNever<Real> && coming.time[1] == kNever<Real>) continue;
    const ContactConstraint<Real>& c = *bounces[i].contact;
    Real until = kNever<Real>;
    for (const int body : {c.body_a, c.body_b})
      if (is_dynamic(motion[body])) until = std::min(until, room.earliest[group_of(room, body)]);
    until += Real(kAtOnce) * h;
    for (int k = 0; k < c.count; ++k) {
      if (coming.time[k] == kNever<Real> || coming.time[k] > until) continue;
      room.struck.push_back(StruckPoint<Real>{.bounce = &bounces[i],
                                              .point = k,
                                              .time = coming.time[k],
                                              .wanted = coming.wanted[k],
                                              .before = coming.before[k]});
    }
  }
  room.looked.clear();
}

// Returns true if a next impact comes after the last impacts of its bodies.
template <class Real>
bool time_passes(const ImpactScratch<Real>& room) {
  return std::any_of(room.struck.begin(), room.struck.end(), [&](const StruckPoint<Real>& at) {
    const ContactConstraint<Real>& c = *at.bounce->contact;
    return at.time > std::max(room.last[group_of(room, c.body_a)], room.last[group_of(room, c.body_b)]);
  });
}

}  // namespace

template <class Real>
bool find_reached_contacts(const BodyMotion<Real>* motion, std::vector<RestitutionContact<Real>>& bounces,
                           const ContactStep<Real>& step, ImpactScratch<Real>& room) {
  find_crowd(motion, bounces, 2 * step.h * fastest_strike(motion, bounces), room);
  return !room.crowd.empty();
}

template <class Real>
int propagate_impacts(BodyMotion<Real>* motion, Rotation<Real>* rotation,
                      std::vector<RestitutionContact<Real>>& bounces, const ContactStep<Real>& step,
                      ImpactScratch<Real>& room) {
  const Real fastest = fastest_strike(motion, bounces);
  const Real least = std::max(step.bounce_threshold, Real(kSlow) * fastest);
  const int size = static_cast<int>(room.crowd.size());
  Real most_restitution = 0;
  for (const int i : room.crowd)
    most_restitution = std::max(most_restitution, bounces[i].contact->restitution);
  int looks = kLooks + static_cast<int>(Real(kLooksToRebound) * most_restitution);
  int at_one_time = kAtOneTime + kAtOneTimeEach * size;
  int round = 0;
  room.looked = room.crowd;
  for (; looks > 0 && at_one_time > 0; ++round) {
    looks -= static_cast<int>(room.looked.size());
    find_struck(motion, bounces, least, step.h, room);
    if (room.struck.empty()) break;
    if (!time_passes(room)) --at_one_time;
    resolve_round(motion, rotation, fastest, looks, room);
    for (const StruckPoint<Real>& at : room.struck) {
      for (const int body : {at.bounce->contact->body_a, at.bounce->contact->body_b})
        if (is_dynamic(motion[body]))
          for_each_at(room, group_of(room, body), [&](int i) { note(room.looked, room.in_list, i); });
    }
  }
  for (const int i : room.crowd) {
    RestitutionContact<Real>& bounce = bounces[i];
    ContactConstraint<Real>& c = *bounce.contact;
    // The remaining approaches are too slow or do not touch within this substep.
    bounce.closes = false;
    bool open = true;
    for (int k = 0; k < c.count; ++k) {
      const Real closing = -velocity_along_normal(motion, c, k);
      c.now[k] = separation_of(motion, c, k);
      bounce.strikes[k] = false;
      bounce.closes = bounce.closes || closing > step.bounce_threshold;
      open = open && c.now[k] > step.h * closing;
    }
    bounce.closes = bounce.closes && open;
  }
  return round;
}

#define PLUMB_FOR(Real)                                                                                      \
  template bool find_reached_contacts(const BodyMotion<Real>*, std::vector<RestitutionContact<Real>>&,       \
                                      const ContactStep<Real>&, ImpactScratch<Real>&);                       \
  template int propagate_impacts(BodyMotion<Real>*, Rotation<Real>*, std::vector<RestitutionContact<Real>>&, \
                                 const ContactStep<Real>&, ImpactScratch<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
