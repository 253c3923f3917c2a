#include "engine/world/contact_solver/impact_propagation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "engine/core/room.h"
#include "engine/math/small_turn.h"
#include "engine/world/contact_solver/contact_pair.h"

namespace plumb {
namespace {

// Impacts closer in time than this fraction of a substep are simultaneous.
constexpr double kAtOnce = 1e-3;
// Approaches below this fraction of the fastest are left to the solver's iterations, which stop them.
constexpr double kSlow = 1e-4;
// The iterations of a round end when no velocity changes by more than this fraction of the fastest.
constexpr double kConverged = 1e-6;
constexpr int kSweeps = 40;
// Maximum number of contacts examined in all rounds of a substep, and of points solved in all iterations of
// theirs: some 2 ms. A stirred heap of 6000 bodies with e = 0.1 always
// reaches it; overlaps and escapes are the same from 4e4 to without a bound, as constraints hold what is
// left.
constexpr int kLooks = 1 << 16;
// Maximum number of rounds of a substep in which no time passes, plus as many for each contact of the group.
// An impact passes to the far end and back in a few rounds. More are needed only if friction or a second wall
// presses a body back at once.
constexpr int kAtOneTime = 64, kAtOneTimeEach = 8;

template <class Real>
bool has_mass(const BodyMotion<Real>& body) {
  return body.inverse_mass > 0;
}

// Returns the present separation of a point, m.
template <class Real>
Real separation_of(const BodyMotion<Real>* motion, const ContactConstraint<Real>& c, int i) {
  const BodyMotion<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return c.separation[i] + dot(c.normal, b.moved - a.moved) + (c.arm_b[i] * b.turned - c.arm_a[i] * a.turned);
}

template <class Real>
void push(BodyMotion<Real>* motion, const ContactConstraint<Real>& c, int i, Real impulse) {
  motion[c.body_a].apply(-impulse * c.normal, -impulse * c.arm_a[i]);
  motion[c.body_b].apply(impulse * c.normal, impulse * c.arm_b[i]);
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
  int bodies = 0;
  for (const RestitutionContact<Real>& bounce : bounces)
    bodies = std::max({bodies, bounce.contact->body_a + 1, bounce.contact->body_b + 1});
  if (static_cast<int>(room.reached.size()) < bodies) {
    make_room(room.reached, bodies), make_room(room.marked, bodies), make_room(room.earliest, bodies);
    make_room(room.last, bodies), make_room(room.first_contact, bodies), make_room(room.group, bodies);
  }
  const int contacts = static_cast<int>(bounces.size());
  if (static_cast<int>(room.in_list.size()) < contacts) {
    make_room(room.in_list, contacts), make_room(room.next, 2 * contacts), make_room(room.coming, contacts);
  }
  for (const RestitutionContact<Real>& bounce : bounces) {
    for (const int body : {bounce.contact->body_a, bounce.contact->body_b}) {
      room.reached[body] = room.marked[body] = 0, room.last[body] = 0;
      room.first_contact[body] = room.group[body] = -1;
    }
  }
  std::fill_n(room.in_list.begin(), contacts, char(0));
  room.crowd.clear(), room.looked.clear(), room.bodies.clear(), room.struck.clear();
}

// Calls visit(contact) for the contacts of a body to which impacts may propagate.
template <class Real, class Visit>
void for_each_at(const ImpactScratch<Real>& room, int body, const Visit& visit) {
  for (int edge = room.first_contact[body]; edge != -1; edge = room.next[edge]) visit(edge / 2);
}

// Marks the contact's bodies as reachable by impact propagation, and lists those that were not before.
template <class Real>
void reach(const BodyMotion<Real>* motion, const ContactConstraint<Real>& c, ImpactScratch<Real>& room) {
  for (const int body : {c.body_a, c.body_b}) {
    if (!has_mass(motion[body]) || room.reached[body]) continue;
    room.reached[body] = 1;
    append(room.bodies, body);
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
      room.next[2 * i + side] = room.first_contact[body], room.first_contact[body] = 2 * i + side;
    }
    if (is_struck(bounces[i])) reach(motion, c, room);
  }
  for (std::size_t next = 0; next < room.bodies.size(); ++next) {
    for_each_at(room, room.bodies[next], [&](int i) {
      room.in_list[i] = 1;
      reach(motion, *bounces[i].contact, room);
    });
  }
  room.bodies.clear();
  for (int i = 0; i < contacts; ++i) {
    if (room.in_list[i] == 0) continue;
    room.in_list[i] = 0;
    append(room.crowd, i);
  }
}

// Adds an item to a list, unless it is in there.
inline void note(std::vector<int>& list, std::vector<char>& noted, int item) {
  if (noted[item]) return;
  noted[item] = 1;
  append(list, item);
}

// Finds when the points of a contact have their next impact, as its bodies move now.
template <class Real>
void look_at(const BodyMotion<Real>* motion, RestitutionContact<Real>& bounce, Real least, Real h,
             const ImpactScratch<Real>& room, ComingImpact<Real>& coming) {
  ContactConstraint<Real>& c = *bounce.contact;
  const Real start = std::max(room.last[c.body_a], room.last[c.body_b]);
  face(motion, bounce, h, std::min(start, h));
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

// Finds the points of the next impacts: for each body those of its earliest one. Looks only at the contacts
// that are listed, whose bodies have had an impact since they were looked at: what is expected of the others
// has not changed.
template <class Real>
void find_struck(const BodyMotion<Real>* motion, std::vector<RestitutionContact<Real>>& bounces, Real least,
                 Real h, ImpactScratch<Real>& room) {
  room.struck.clear(), room.bodies.clear();
  for (const int i : room.looked) {
    room.in_list[i] = 0;
    look_at(motion, bounces[i], least, h, room, room.coming[i]);
    for (const int body : {bounces[i].contact->body_a, bounces[i].contact->body_b})
      if (has_mass(motion[body])) note(room.bodies, room.marked, body);
  }
  room.looked.clear();
  for (const int body : room.bodies) {
    Real earliest = kNever<Real>;
    for_each_at(room, body, [&](int i) {
      const Real(&time)[2] = room.coming[i].time;
      earliest = std::min(earliest, std::min(time[0], time[1]));
      note(room.looked, room.in_list, i);
    });
    room.earliest[body] = earliest;
    room.marked[body] = 0;
  }
  std::sort(room.looked.begin(), room.looked.end());
  for (const int i : room.looked) {
    room.in_list[i] = 0;
    const ContactConstraint<Real>& c = *bounces[i].contact;
    const ComingImpact<Real>& coming = room.coming[i];
    Real until = kNever<Real>;
    for (const int body : {c.body_a, c.body_b})
      if (has_mass(motion[body])) until = std::min(until, room.earliest[body]);
    until += Real(kAtOnce) * h;
    for (int k = 0; k < c.count; ++k) {
      if (coming.time[k] == kNever<Real> || coming.time[k] > until) continue;
      append(room.struck,
             StruckPoint<Real>{&bounces[i], k, coming.time[k], coming.wanted[k], coming.before[k], 0});
    }
  }
  room.looked.clear();
}

// Orders the struck points by groups that share no dynamic body, and within a group as they were.
template <class Real>
void group_struck(const BodyMotion<Real>* motion, ImpactScratch<Real>& room) {
  std::vector<StruckPoint<Real>>& struck = room.struck;
  const int count = static_cast<int>(struck.size());
  const auto first_of = [&](int i) {
    while (struck[i].group != i) i = struck[i].group = struck[struck[i].group].group;
    return i;
  };
  for (int i = 0; i < count; ++i) {
    struck[i].group = i;
    for (const int body : {struck[i].bounce->contact->body_a, struck[i].bounce->contact->body_b}) {
      if (!is_dynamic(motion[body])) continue;
      if (room.group[body] == -1) room.group[body] = i;
      const int one = first_of(i), other = first_of(room.group[body]);
      struck[std::max(one, other)].group = std::min(one, other);
    }
  }
  for (int i = 0; i < count; ++i) {
    struck[i].group = first_of(i);
    room.group[struck[i].bounce->contact->body_a] = room.group[struck[i].bounce->contact->body_b] = -1;
  }
  // The list is in the order of contacts and points.
  std::sort(struck.begin(), struck.end(), [](const StruckPoint<Real>& a, const StruckPoint<Real>& b) {
    if (a.group != b.group) return a.group < b.group;
    return a.bounce != b.bounce ? a.bounce < b.bounce : a.point < b.point;
  });
}

// Solves lambda >= 0 with n.v >= wanted by sequential impulses, such that no energy is gained.
template <class Real>
void exchange(BodyMotion<Real>* motion, std::span<StruckPoint<Real>> struck, Real fastest, int& looks) {
  bool changes = true;
  for (int sweep = 0; changes && sweep < kSweeps && (sweep == 0 || looks > 0); ++sweep) {
    looks -= static_cast<int>(struck.size());
    changes = false;
    for (StruckPoint<Real>& at : struck) {
      const ContactConstraint<Real>& c = *at.bounce->contact;
      const Real missing = at.wanted - velocity_along_normal(motion, c, at.point);
      const Real impulse = std::max(at.impulse + c.mass[at.point] * missing, Real(0));
      const Real change = impulse - at.impulse;
      if (std::abs(change) > Real(kConverged) * fastest * c.mass[at.point]) changes = true;
      push(motion, c, at.point, change);
      at.impulse = impulse;
    }
  }
  Real before = 0, after = 0;
  for (const StruckPoint<Real>& at : struck) {
    before += at.impulse * at.before;
    after += at.impulse * velocity_along_normal(motion, *at.bounce->contact, at.point);
  }
  if (!(before + after > 0)) return;
  // Scaled by k, the impulses change the energy by k (before + k (after - before) / 2), which is 0 here.
  const Real scale = -2 * before / (after - before);
  for (StruckPoint<Real>& at : struck) {
    push(motion, *at.bounce->contact, at.point, (scale - 1) * at.impulse);
    at.impulse *= scale;
  }
}

template <class Real>
void exchange_by_groups(BodyMotion<Real>* motion, Real fastest, int& looks, ImpactScratch<Real>& room) {
  group_struck(motion, room);
  const std::span<StruckPoint<Real>> struck(room.struck);
  for (std::size_t first = 0, end = 0; first < struck.size(); first = end) {
    while (end < struck.size() && struck[end].group == struck[first].group) ++end;
    exchange(motion, struck.subspan(first, end - first), fastest, looks);
  }
}

// Applies friction to a point after its impact and corrects the displacement. Both impulses act only from the
// time of impact on, not over the whole substep.
template <class Real>
void finish_impact(BodyMotion<Real>* motion, Rotation<Real>* rotation, const StruckPoint<Real>& at,
                   ImpactScratch<Real>& room) {
  ContactConstraint<Real>& c = *at.bounce->contact;
  BodyMotion<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  const Vec2<Real> t{c.normal.y, -c.normal.x};
  const Real sliding = dot(t, b.velocity - a.velocity) + c.arm_tangent_b * b.angular_velocity -
                       c.arm_tangent_a * a.angular_velocity - c.surface_speed;
  const Real most = c.friction * at.impulse;
  const Real friction = std::clamp(-c.tangent_mass * sliding, -most, most);
  a.apply(-friction * t, -friction * c.arm_tangent_a);
  b.apply(friction * t, friction * c.arm_tangent_b);
  note_approach(c, at.point, at.before);
  c.peak_impulse[at.point] = std::max(c.peak_impulse[at.point], at.impulse);
  at.bounce->strikes[at.point] = false;

  const Vec2<Real> way = -at.time * (at.impulse * c.normal + friction * t);
  const auto move_back = [&](int body, Real sign, Real angular) {
    BodyMotion<Real>& moving = motion[body];
    moving.moved += (sign * moving.inverse_mass) * way;
    const Real turn = -sign * at.time * moving.inverse_inertia * angular;
    if (turn != 0) moving.turned += turn, rotation[body] = turned_by(rotation[body], turn);
    if (has_mass(moving)) room.last[body] = std::max(room.last[body], at.time);
  };
  move_back(c.body_a, -1, at.impulse * c.arm_a[at.point] + friction * c.arm_tangent_a);
  move_back(c.body_b, 1, at.impulse * c.arm_b[at.point] + friction * c.arm_tangent_b);
}

// Returns true if a next impact comes after the last impacts of its bodies.
template <class Real>
bool time_passes(const ImpactScratch<Real>& room) {
  return std::any_of(room.struck.begin(), room.struck.end(), [&](const StruckPoint<Real>& at) {
    const ContactConstraint<Real>& c = *at.bounce->contact;
    return at.time > std::max(room.last[c.body_a], room.last[c.body_b]);
  });
}

}  // namespace

template <class Real>
int propagate_impacts(BodyMotion<Real>* motion, Rotation<Real>* rotation,
                      std::vector<RestitutionContact<Real>>& bounces, const ContactStep<Real>& step,
                      ImpactScratch<Real>& room) {
  const Real fastest = fastest_strike(motion, bounces);
  find_crowd(motion, bounces, 2 * step.h * fastest, room);
  if (room.crowd.empty()) return 0;
  const Real least = std::max(step.bounce_threshold, Real(kSlow) * fastest);
  const int size = static_cast<int>(room.crowd.size());
  int looks = kLooks;
  int at_one_time = kAtOneTime + kAtOneTimeEach * size;
  int round = 0;
  room.looked = room.crowd;
  for (; looks > 0 && at_one_time > 0; ++round) {
    looks -= static_cast<int>(room.looked.size());
    find_struck(motion, bounces, least, step.h, room);
    if (room.struck.empty()) break;
    if (!time_passes(room)) --at_one_time;
    exchange_by_groups(motion, fastest, looks, room);
    for (const StruckPoint<Real>& at : room.struck) {
      finish_impact(motion, rotation, at, room);
      for (const int body : {at.bounce->contact->body_a, at.bounce->contact->body_b})
        if (is_dynamic(motion[body]))
          for_each_at(room, body, [&](int i) { note(room.looked, room.in_list, i); });
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
  template int propagate_impacts(BodyMotion<Real>*, Rotation<Real>*, std::vector<RestitutionContact<Real>>&, \
                                 const ContactStep<Real>&, ImpactScratch<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
