#include "engine/world/contact_solver/impact_propagation.h"

#include <algorithm>
#include <limits>

#include "engine/core/capacity.h"
#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/contact_solver/impact_round.h"

namespace plumb {
namespace {

// Impacts whose times differ by less than this fraction of a substep are simultaneous.
constexpr double kAtOnce = 1e-3;
// Approaches below this fraction of the fastest are left to the solver's iterations, which stop them.
constexpr double kSlow = 1e-4;
// Limits on the work of a substep, counted in looks: contacts examined in all rounds, and points solved in
// all their iterations. The limit is kLooks plus, for rebounds, kLooksToRebound times the largest restitution
// e of the impacts; with e = 1 about 2 ms. Impacts beyond it are left to the constraints and lose their
// rebounds, the fraction e of the approach. If the limit does not suffice for a first round, this round is
// skipped at once: its impulses would be those of an unfinished iteration. A stirred heap of 6000 bodies with
// e = 0.1 exceeds the limit in nearly every substep. With a limit six times as large its overlaps are smaller
// by 3 %.
constexpr int kLooks = 1 << 12, kLooksToRebound = 1 << 16;
// Least number of iterations over the points of a round: one that solves them, and one that finds no change.
constexpr int kLeastSweeps = 2;
// Maximum number of rounds of a substep in which no time passes, plus as many for each contact of the group.
// An impact passes to the far end and back in a few rounds. More rounds are needed only if friction or a
// second wall pushes a body back at once.
constexpr int kAtOneTime = 64, kAtOneTimeEach = 8;

// Returns the present separation of a point, m.
template <class Real>
Real separation_of(const SolverBody<Real>* motion, const ContactConstraint<Real>& c, int i) {
  const SolverBody<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return c.separation[i] + dot(c.normal, b.delta_position - a.delta_position) +
         (c.arm_b[i] * b.delta_angle - c.arm_a[i] * a.delta_angle);
}

template <class Real>
bool is_struck(const RestitutionContact<Real>& bounce) {
  return bounce.strikes[0] || bounce.strikes[1];
}

// Returns the limit on looks for impacts with this largest restitution e.
template <class Real>
int looks_for(Real restitution) {
  return kLooks + static_cast<int>(Real(kLooksToRebound) * restitution);
}

// Finds the contacts that have impacts, their fastest approach and their largest restitution.
template <class Real>
void find_strikes(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                  ImpactScratch<Real>& room) {
  room.strikes.clear(), ensure_capacity(room.strikes, bounces.size());
  room.struck_points = 0, room.fastest = room.most_restitution = 0;
  for (std::size_t at = 0; at < bounces.size(); ++at) {
    const RestitutionContact<Real>& bounce = bounces[at];
    if (!is_struck(bounce)) continue;
    room.strikes.push_back(static_cast<int>(at));
    const ContactConstraint<Real>& c = *bounce.contact;
    room.most_restitution = std::max(room.most_restitution, c.restitution);
    for (int i = 0; i < c.count; ++i) {
      if (!bounce.strikes[i]) continue;
      ++room.struck_points;
      room.fastest = std::max(room.fastest, -velocity_along_normal(motion, c, i));
    }
  }
}

// Stands for the time of a point without a next impact.
template <class Real>
constexpr Real kNever = std::numeric_limits<Real>::infinity();

// Resizes the lists for the groups and contacts of a step, without impacts.
template <class Real>
void clear_room(const std::vector<RestitutionContact<Real>>& bounces, ImpactScratch<Real>& room) {
  int bodies = static_cast<int>(room.group.size());
  for (const RestitutionContact<Real>& bounce : bounces)
    bodies = std::max({bodies, bounce.contact->body_a + 1, bounce.contact->body_b + 1});
  const int contacts = static_cast<int>(bounces.size());
  for (std::vector<char>* const flags : {&room.marked, &room.struck_now}) {
    if (static_cast<int>(flags->size()) < bodies) resize_with_growth(*flags, bodies);
    std::fill_n(flags->begin(), bodies, char(0));
  }
  for (std::vector<int>* const places : {&room.first_contact, &room.struck_at}) {
    if (static_cast<int>(places->size()) < bodies) resize_with_growth(*places, bodies);
    std::fill_n(places->begin(), bodies, -1);
  }
  if (static_cast<int>(room.earliest.size()) < bodies) resize_with_growth(room.earliest, bodies);
  if (static_cast<int>(room.last.size()) < bodies) resize_with_growth(room.last, bodies);
  std::fill_n(room.last.begin(), bodies, Real(0));
  if (static_cast<int>(room.way.size()) < bodies) {
    resize_with_growth(room.way, bodies), resize_with_growth(room.turn, bodies);
    ensure_capacity(room.displaced, room.way.size());
  }
  if (static_cast<int>(room.in_list.size()) < contacts) {
    resize_with_growth(room.in_list, contacts), resize_with_growth(room.seen, contacts);
    resize_with_growth(room.next, 2 * contacts), resize_with_growth(room.coming, contacts);
    const std::size_t points = room.next.size();
    ensure_capacity(room.struck, points), ensure_capacity(room.grouped, points);
    ensure_capacity(room.following, points), ensure_capacity(room.latest, points);
    ensure_capacity(room.looked, room.in_list.size()), ensure_capacity(room.all_seen, room.in_list.size());
    ensure_capacity(room.groups, points);
  }
  std::fill_n(room.in_list.begin(), contacts, char(0)), std::fill_n(room.seen.begin(), contacts, char(0));
  for (int i = 0; i < contacts; ++i) room.coming[i].time[0] = room.coming[i].time[1] = kNever<Real>;
  room.looked.clear(), room.groups.clear(), room.struck.clear(), room.all_seen.clear();
}

// Calls visit(contact) for the contacts of a group.
template <class Real, class Visit>
void for_each_at(const ImpactScratch<Real>& room, int group, const Visit& visit) {
  for (int edge = room.first_contact[group]; edge != -1; edge = room.next[edge]) visit(edge / 2);
}

// Adds an item to a list, unless the list contains it. Lists have capacity for all items (`clear_room`).
inline void note(std::vector<int>& list, std::vector<char>& noted, int item) {
  if (noted[item]) return;
  noted[item] = 1;
  list.push_back(item);
}

// Finds the time of the next impact of each point of a contact, for the present motion of its bodies.
template <class Real>
void look_at(const SolverBody<Real>* motion, RestitutionContact<Real>& bounce, Real least, Real h,
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
[[gnu::always_inline]] inline void prefetch_listed(const SolverBody<Real>* motion,
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

// Brings the contacts of a list, all marked, into the order of all `contacts`. Clears the marks.
template <class Real>
void arrange_looked(int contacts, ImpactScratch<Real>& room) {
  constexpr int kSorted = 16;  // lists shorter than 1/16 of all contacts are sorted directly
  if (kSorted * static_cast<int>(room.looked.size()) < contacts) {
    std::sort(room.looked.begin(), room.looked.end());
    for (const int i : room.looked) room.in_list[i] = 0;
    return;
  }
  room.looked.clear();
  for (int i = 0; i < contacts; ++i) {
    if (room.in_list[i] == 0) continue;
    room.in_list[i] = 0;
    room.looked.push_back(i);
  }
}

// Finds the points of the next impacts: for each body those of its earliest one. Examines only the listed
// contacts, whose bodies have had an impact since they were last examined; the predictions for the others
// have not changed.
template <class Real>
void find_struck(const SolverBody<Real>* motion, std::vector<RestitutionContact<Real>>& bounces, Real least,
                 Real h, ImpactScratch<Real>& room) {
  room.struck.clear(), room.groups.clear();
  for (std::size_t k = 0; k < room.looked.size(); ++k) {
    prefetch_listed(motion, bounces, room.looked, k);
    const int i = room.looked[k];
    room.in_list[i] = 0;
    note(room.all_seen, room.seen, i);
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
  arrange_looked(static_cast<int>(bounces.size()), room);
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

// Updates the contacts whose bodies the impacts have moved, and forgets the impacts.
template <class Real>
void settle(const SolverBody<Real>* motion, std::vector<RestitutionContact<Real>>& bounces,
            const ContactStep<Real>& step, ImpactScratch<Real>& room) {
  for (const int i : room.looked) room.in_list[i] = 0, note(room.all_seen, room.seen, i);
  for (const int i : room.all_seen) {
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
    room.seen[i] = 0;
    room.coming[i].time[0] = room.coming[i].time[1] = kNever<Real>;
    for (const int body : {c.body_a, c.body_b}) room.last[group_of(room, body)] = 0;
  }
  room.looked.clear(), room.all_seen.clear();
}

}  // namespace

template <class Real>
bool find_impacts(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                  ImpactScratch<Real>& room) {
  find_strikes(motion, bounces, room);
  const int first_round = static_cast<int>(room.strikes.size()) + kLeastSweeps * room.struck_points;
  return room.struck_points > 0 && first_round <= looks_for(room.most_restitution);
}

template <class Real>
void link_contacts(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                   ImpactScratch<Real>& room) {
  clear_room(bounces, room);
  for (int i = static_cast<int>(bounces.size()) - 1; i >= 0; --i) {
    const ContactConstraint<Real>& c = *bounces[i].contact;
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? c.body_a : c.body_b;
      if (!is_dynamic(motion[body])) continue;
      int& first = room.first_contact[group_of(room, body)];
      room.next[2 * i + side] = first, first = 2 * i + side;
    }
  }
}

template <class Real>
int propagate_impacts(SolverBody<Real>* motion, Rotation<Real>* rotation,
                      std::vector<RestitutionContact<Real>>& bounces, const ContactStep<Real>& step,
                      ImpactScratch<Real>& room) {
  const Real least = std::max(step.bounce_threshold, Real(kSlow) * room.fastest);
  int looks = looks_for(room.most_restitution);
  for (const int body : room.displaced) room.way[body] = {}, room.turn[body] = 0;
  room.displaced.clear();
  int round = 0, at_one_time = 0;
  room.looked = room.strikes;
  for (; static_cast<int>(room.looked.size()) < looks; ++round) {
    looks -= static_cast<int>(room.looked.size());
    find_struck(motion, bounces, least, step.h, room);
    if (room.struck.empty()) break;
    if (!time_passes(room)) ++at_one_time;
    resolve_round(motion, rotation, room.fastest, looks, room);
    for (const StruckPoint<Real>& at : room.struck) {
      for (const int body : {at.bounce->contact->body_a, at.bounce->contact->body_b})
        if (is_dynamic(motion[body]))
          for_each_at(room, group_of(room, body), [&](int i) { note(room.looked, room.in_list, i); });
    }
    if (at_one_time >= kAtOneTime + kAtOneTimeEach * static_cast<int>(room.all_seen.size())) break;
  }
  settle(motion, bounces, step, room);
  return round;
}

#define PLUMB_FOR(Real)                                                                                      \
  template bool find_impacts(const SolverBody<Real>*, const std::vector<RestitutionContact<Real>>&,          \
                             ImpactScratch<Real>&);                                                          \
  template void link_contacts(const SolverBody<Real>*, const std::vector<RestitutionContact<Real>>&,         \
                              ImpactScratch<Real>&);                                                         \
  template int propagate_impacts(SolverBody<Real>*, Rotation<Real>*, std::vector<RestitutionContact<Real>>&, \
                                 const ContactStep<Real>&, ImpactScratch<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
