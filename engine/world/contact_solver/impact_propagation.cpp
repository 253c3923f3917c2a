#include "engine/world/contact_solver/impact_propagation.h"

#include <algorithm>
#include <cmath>

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
// Maximum number of contacts examined in all rounds of a substep.
constexpr int kLooks = 1 << 17;
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

template <class Real>
void clear_room(const std::vector<RestitutionContact<Real>>& bounces, ImpactScratch<Real>& room) {
  int bodies = 0;
  for (const RestitutionContact<Real>& bounce : bounces)
    bodies = std::max({bodies, bounce.contact->body_a + 1, bounce.contact->body_b + 1});
  if (static_cast<int>(room.reached.size()) < bodies) {
    room.reached.resize(bodies);
    room.earliest.resize(bodies), room.last.resize(bodies);
  }
  for (const RestitutionContact<Real>& bounce : bounces) {
    for (const int body : {bounce.contact->body_a, bounce.contact->body_b})
      room.reached[body] = 0, room.last[body] = 0;
  }
  room.cluster.clear();
}

// Marks the contact's bodies as reachable by impact propagation. Returns true if one was not marked before.
template <class Real>
bool reach(const BodyMotion<Real>* motion, const ContactConstraint<Real>& c, ImpactScratch<Real>& room) {
  bool more = false;
  for (const int body : {c.body_a, c.body_b}) {
    if (!has_mass(motion[body]) || room.reached[body]) continue;
    room.reached[body] = 1;
    more = true;
  }
  return more;
}

// Collects the contacts with impacts and all contacts to which these may propagate.
template <class Real>
void find_crowd(const BodyMotion<Real>* motion, std::vector<RestitutionContact<Real>>& bounces, Real within,
                ImpactScratch<Real>& room) {
  clear_room(bounces, room);
  const auto is_near = [&](const RestitutionContact<Real>& bounce) {
    return is_struck(bounce) || nearest_point(*bounce.contact) <= within;
  };
  bool more = false;
  for (const RestitutionContact<Real>& bounce : bounces)
    if (is_struck(bounce)) more = reach(motion, *bounce.contact, room) || more;
  const auto is_reached = [&](const RestitutionContact<Real>& bounce) {
    return is_near(bounce) && (room.reached[bounce.contact->body_a] || room.reached[bounce.contact->body_b]);
  };
  if (!more) return;
  while (more) {
    more = false;
    for (const RestitutionContact<Real>& bounce : bounces) {
      if (is_reached(bounce)) more = reach(motion, *bounce.contact, room) || more;
    }
  }
  for (RestitutionContact<Real>& bounce : bounces) {
    if (is_reached(bounce)) room.cluster.push_back(&bounce);
  }
}

// Finds the points of the next impacts: for each body those of its earliest one.
template <class Real>
void find_struck(const BodyMotion<Real>* motion, Real least, Real h, ImpactScratch<Real>& room) {
  room.struck.clear();
  for (const RestitutionContact<Real>* bounce : room.cluster) {
    room.earliest[bounce->contact->body_a] = room.earliest[bounce->contact->body_b] = 2 * h;
  }
  for (RestitutionContact<Real>* bounce : room.cluster) {
    ContactConstraint<Real>& c = *bounce->contact;
    const Real start = std::max(room.last[c.body_a], room.last[c.body_b]);
    face(motion, *bounce, h, std::min(start, h));
    for (int i = 0; i < c.count; ++i) {
      const Real closing = -velocity_along_normal(motion, c, i);
      const Real s = std::max(separation_of(motion, c, i), Real(0));
      if (!(closing > least) || s > closing * h) continue;
      const Real time = std::max(s / closing, start);
      // A point without an earlier impact bounces as `schedule_impacts` set it, with the effect of gravity
      // before and after.
      const bool placed = start == 0 && bounce->strikes[i];
      const Real wanted = placed ? bounce->speed[i] : c.restitution * closing;
      room.struck.push_back({bounce, i, time, wanted, -closing, 0});
      for (const int body : {c.body_a, c.body_b}) {
        if (has_mass(motion[body])) room.earliest[body] = std::min(room.earliest[body], time);
      }
    }
  }
  std::erase_if(room.struck, [&](const StruckPoint<Real>& at) {
    const ContactConstraint<Real>& c = *at.bounce->contact;
    return at.time > std::min(room.earliest[c.body_a], room.earliest[c.body_b]) + Real(kAtOnce) * h;
  });
}

// Solves lambda >= 0 with n.v >= wanted by sequential impulses, such that no energy is gained.
template <class Real>
void exchange(BodyMotion<Real>* motion, std::vector<StruckPoint<Real>>& struck, Real fastest) {
  bool changes = true;
  for (int sweep = 0; changes && sweep < kSweeps; ++sweep) {
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
  if (room.cluster.empty()) return 0;
  const Real least = std::max(step.bounce_threshold, Real(kSlow) * fastest);
  const int size = static_cast<int>(room.cluster.size());
  const int rounds = std::max(kLooks / size, 8);
  int at_one_time = kAtOneTime + kAtOneTimeEach * size;
  int round = 0;
  for (; round < rounds && at_one_time > 0; ++round) {
    find_struck(motion, least, step.h, room);
    if (room.struck.empty()) break;
    if (!time_passes(room)) --at_one_time;
    exchange(motion, room.struck, fastest);
    for (const StruckPoint<Real>& at : room.struck) finish_impact(motion, rotation, at, room);
  }
  for (RestitutionContact<Real>* bounce : room.cluster) {
    ContactConstraint<Real>& c = *bounce->contact;
    // The remaining approaches are too slow or do not touch within this substep.
    bounce->closes = false;
    bool open = true;
    for (int i = 0; i < c.count; ++i) {
      const Real closing = -velocity_along_normal(motion, c, i);
      c.now[i] = separation_of(motion, c, i);
      bounce->strikes[i] = false;
      bounce->closes = bounce->closes || closing > step.bounce_threshold;
      open = open && c.now[i] > step.h * closing;
    }
    bounce->closes = bounce->closes && open;
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
