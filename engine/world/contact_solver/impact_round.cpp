#include "engine/world/contact_solver/impact_round.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/core/capacity.h"
#include "engine/world/contact_solver/locked_axes.h"

namespace plumb {
namespace {

// The iterations of a round end when no velocity changes by more than this fraction of the fastest.
constexpr double kConverged = 1e-6;
constexpr int kSweeps = 40;

// Maximum cost of factorising the rows of a round's joints, in multiplications: some 0.1 ms. Beyond it joints
// react to impacts only in the solver's next iterations, which lose energy.
constexpr double kJointsCost = 2e5;

template <class Real>
void push(SolverBody<Real>* motion, const ContactConstraint<Real>& c, int i, Real impulse) {
  motion[c.body_a].apply(-impulse * free_of_a(c.normal, c.locks), -impulse * c.arm_a[i]);
  motion[c.body_b].apply(impulse * free_of_b(c.normal, c.locks), impulse * c.arm_b[i]);
}

// Sorts the struck points by groups that share no dynamic body; within a group their order is kept.
template <class Real>
void group_struck(const SolverBody<Real>* motion, ImpactScratch<Real>& room) {
  std::vector<StruckPoint<Real>>& struck = room.struck;
  const int count = static_cast<int>(struck.size());
  std::vector<int>&following = room.following, &latest = room.latest;
  following.assign(struck.size(), -1), latest.assign(struck.size(), -1);
  const auto first_of = [&](int i) {
    while (struck[i].group != i) i = struck[i].group = struck[struck[i].group].group;
    return i;
  };
  for (int i = 0; i < count; ++i) {
    struck[i].group = i;
    for (const int body : {struck[i].bounce->contact->body_a, struck[i].bounce->contact->body_b}) {
      if (!is_dynamic(motion[body])) continue;
      int& at = room.struck_at[group_of(room, body)];
      if (at == -1) at = i;
      const int one = first_of(i), other = first_of(at);
      struck[std::max(one, other)].group = std::min(one, other);
    }
  }
  for (int i = 0; i < count; ++i) {
    const int group = struck[i].group = first_of(i);
    if (group != i) following[latest[group]] = i;
    latest[group] = i;
    for (const int body : {struck[i].bounce->contact->body_a, struck[i].bounce->contact->body_b})
      room.struck_at[group_of(room, body)] = -1;
  }
  room.grouped.clear();
  for (int i = 0; i < count; ++i)
    for (int k = struck[i].group == i ? i : -1; k != -1; k = following[k]) append(room.grouped, struck[k]);
  struck.swap(room.grouped);
}

// Returns the relative sliding speed of a contact's bodies minus the surface speed, m/s.
template <class Real>
Real sliding_of(const SolverBody<Real>* motion, const ContactConstraint<Real>& c) {
  const SolverBody<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return dot(Vec2<Real>{c.normal.y, -c.normal.x}, b.velocity - a.velocity) +
         c.arm_tangent_b * b.angular_velocity - c.arm_tangent_a * a.angular_velocity - c.surface_speed;
}

template <class Real>
void push_along(SolverBody<Real>* motion, const ContactConstraint<Real>& c, Real friction) {
  const Vec2<Real> t{c.normal.y, -c.normal.x};
  motion[c.body_a].apply(-friction * free_of_a(t, c.locks), -friction * c.arm_tangent_a);
  motion[c.body_b].apply(friction * free_of_b(t, c.locks), friction * c.arm_tangent_b);
}

// Returns the work that a round's impulses would do at the velocities before the round, J.
template <class Real>
Real work_before(std::span<const StruckPoint<Real>> struck) {
  Real work = 0;
  for (const StruckPoint<Real>& at : struck) work += at.impulse * at.before + at.friction * at.sliding;
  return work;
}

// Returns the same work at the current velocities, J.
template <class Real>
Real work_of(const SolverBody<Real>* motion, std::span<const StruckPoint<Real>> struck) {
  Real work = 0;
  for (const StruckPoint<Real>& at : struck) {
    const ContactConstraint<Real>& c = *at.bounce->contact;
    work += at.impulse * velocity_along_normal(motion, c, at.point);
    if (at.friction != 0) work += at.friction * sliding_of(motion, c);
  }
  return work;
}

// Returns the largest factor, at most 1, by which a round's impulses can be scaled without gaining energy,
// from their work at the velocities before and after the round. Scaled by k they change the energy by k
// (before + k (after - before) / 2).
template <class Real>
Real energy_scale(Real before, Real after) {
  return before + after > 0 ? -2 * before / (after - before) : Real(1);
}

// Solves lambda >= 0 with n.v >= wanted by sequential impulses, and Coulomb's friction with it, such that no
// energy is gained. Friction is solved after the normals; where it rotates bodies, the normals are solved
// again: a box that lands flat then leaves with the same speed at both ends.
template <class Real>
void exchange(SolverBody<Real>* motion, std::span<StruckPoint<Real>> struck, Real fastest, int& looks) {
  // Returns true if a normal impulse changes.
  const auto press = [&] {
    bool changes = false;
    for (StruckPoint<Real>& at : struck) {
      const ContactConstraint<Real>& c = *at.bounce->contact;
      const Real missing = at.wanted - velocity_along_normal(motion, c, at.point);
      const Real impulse = std::max(at.impulse + c.mass[at.point] * missing, Real(0));
      const Real change = impulse - at.impulse;
      if (std::abs(change) > Real(kConverged) * fastest * c.mass[at.point]) changes = true;
      push(motion, c, at.point, change);
      at.impulse = impulse;
    }
    return changes;
  };
  const auto rub = [&] {
    for (StruckPoint<Real>& at : struck) {
      const ContactConstraint<Real>& c = *at.bounce->contact;
      const Real most = c.friction * at.impulse;
      if (!(most > 0) && at.friction == 0) continue;
      const Real friction = std::clamp(at.friction - c.tangent_mass * sliding_of(motion, c), -most, most);
      push_along(motion, c, friction - at.friction);
      at.friction = friction;
    }
  };
  bool changes = true, rubs = false;
  for (int sweep = 0; changes && sweep < kSweeps && (sweep == 0 || looks > 0); ++sweep) {
    looks -= static_cast<int>(struck.size());
    changes = press() && struck.size() > 1;  // a single point needs no iteration
  }
  for (StruckPoint<Real>& at : struck) rubs = rubs || at.bounce->contact->friction * at.impulse > 0;
  if (rubs) rub();
  for (int sweep = 0; rubs && sweep < kSweeps && (sweep == 0 || looks > 0); ++sweep) {
    looks -= static_cast<int>(struck.size());
    rubs = press() && struck.size() > 1;
  }
  const Real scale = energy_scale(work_before<Real>(struck), work_of<Real>(motion, struck));
  if (scale == 1) return;
  for (StruckPoint<Real>& at : struck) {
    push(motion, *at.bounce->contact, at.point, (scale - 1) * at.impulse);
    push_along(motion, *at.bounce->contact, (scale - 1) * at.friction);
    at.impulse *= scale, at.friction *= scale;
  }
}

template <class Real>
void note_impact(const StruckPoint<Real>& at) {
  ContactConstraint<Real>& c = *at.bounce->contact;
  if (c.watched != Watch::Off) {
    note_approach(c, at.point, at.before);
    c.peak_impulse[at.point] = std::max(c.peak_impulse[at.point], at.impulse);
    c.step_impulse += at.impulse;
  }
  at.bounce->strikes[at.point] = false;
}

// Corrects the displacement: impulses act only from the time of impact on, not over the whole substep.
template <class Real>
void finish_impact(SolverBody<Real>* motion, Rotation<Real>* rotation, const StruckPoint<Real>& at,
                   ImpactScratch<Real>& room) {
  const ContactConstraint<Real>& c = *at.bounce->contact;
  const Vec2<Real> t{c.normal.y, -c.normal.x};
  const Real friction = at.friction;
  note_impact(at);
  const Vec2<Real> way = -at.time * (at.impulse * c.normal + friction * t);
  const auto move_back = [&](int body, Real sign, Vec2<Real> back, Real angular) {
    SolverBody<Real>& moving = motion[body];
    displace(room, moving, rotation[body], body, (sign * moving.inverse_mass) * back,
             -sign * at.time * moving.inverse_inertia * angular);
    Real& last = room.last[group_of(room, body)];
    if (is_dynamic(moving)) last = std::max(last, at.time);
  };
  move_back(c.body_a, -1, free_of_a(way, c.locks),
            at.impulse * c.arm_a[at.point] + friction * c.arm_tangent_a);
  move_back(c.body_b, 1, free_of_b(way, c.locks),
            at.impulse * c.arm_b[at.point] + friction * c.arm_tangent_b);
}

// The impacts of a group of struck points in a round, with the joints of their bodies.
template <class Real>
class JointedRound {
 public:
  JointedRound(SolverBody<Real>* motion, Rotation<Real>* rotation, std::span<StruckPoint<Real>> struck,
               ImpactScratch<Real>& room)
      : motion_(motion), rotation_(rotation), struck_(struck), room_(room), system_(room.system) {}

  // Collects the bodies and rows. Returns false if no joint takes part, or if there are too many rows.
  bool collect() {
    if (room_.joints.empty()) return false;
    room_.links.clear(), room_.blocks.clear(), room_.sizes.clear(), room_.taking_part.clear();
    system_.bodies.clear();
    for (const StruckPoint<Real>& at : struck_) add_joints(at);
    for (const StruckPoint<Real>& at : struck_) forget(at);
    if (room_.taking_part.empty()) return false;
    const ContactConstraint<Real>* last = nullptr;
    for (const StruckPoint<Real>& at : struck_) {
      const ContactConstraint<Real>& c = *at.bounce->contact;
      if (&c != last) add_block(c.body_a, c.body_b, 0);
      room_.sizes.back() += c.friction > 0 ? 2 : 1;
      last = &c;
    }
    return system_.order(room_.blocks, room_.sizes) <= kJointsCost;
  }

  void resolve() {
    exchange();
    for (const typename ImpactScratch<Real>::Link& link : room_.links) {
      SolverBody<Real>& moving = motion_[link.body];
      if (!is_dynamic(moving)) continue;
      const int group = group_of(room_, link.body);
      const Real time = room_.earliest[group];
      displace(room_, moving, rotation_[link.body], link.body, -time * (moving.velocity - link.velocity),
               -time * (moving.angular_velocity - link.spin));
      room_.last[group] = std::max(room_.last[group], time);
    }
    for (const StruckPoint<Real>& at : struck_) note_impact(at);
  }

 private:
  // Adds the joints of a point's bodies, those of each group once.
  void add_joints(const StruckPoint<Real>& at) {
    for (const int body : {at.bounce->contact->body_a, at.bounce->contact->body_b}) {
      const int group = group_of(room_, body);
      if (!is_dynamic(motion_[body]) || room_.struck_now[group]) continue;
      room_.struck_now[group] = 1;
      for (int i = room_.first_joint[group]; i != -1; i = room_.joints[i].next) {
        ImpactJoint& joint = room_.joints[i];
        if (!joint.known) room_.fill_rows(room_.world, joint), joint.known = true;
        if (joint.rows == 0) continue;
        room_.taking_part.push_back(i);
        add_block(joint.a, joint.b, joint.rows);
      }
    }
  }

  void forget(const StruckPoint<Real>& at) {
    for (const int body : {at.bounce->contact->body_a, at.bounce->contact->body_b})
      room_.struck_now[group_of(room_, body)] = 0;
  }

  int link_at(int body) {
    if (static_cast<int>(room_.link_of.size()) <= body) room_.link_of.resize(body + 1);
    int& place = room_.link_of[body];
    if (place < static_cast<int>(room_.links.size()) && room_.links[place].body == body) return place;
    place = static_cast<int>(room_.links.size());
    const SolverBody<Real>& from = motion_[body];
    room_.links.push_back({body, from.velocity, from.angular_velocity});
    const double inverse_mass = from.inverse_mass;
    system_.bodies.push_back(
        {.inverse_mass = {inverse_mass, inverse_mass}, .inverse_inertia = from.inverse_inertia});
    return place;
  }

  void add_block(int a, int b, int rows) {
    const int link_a = link_at(a);
    room_.blocks.emplace_back(link_a, link_at(b));
    room_.sizes.push_back(rows);
  }

  // Adds the joints' rows, which must keep their rates from before the round. A limit only stops motion
  // beyond it: if it kept its rate while it opens, it would do work, and two contacts that press it in turn
  // would open it ever faster.
  void add_joint_rows() {
    system_.rows.clear();
    int block = 0;
    for (const int part : room_.taking_part) {
      const ImpactJoint& joint = room_.joints[part];
      const auto [link_a, link_b] = room_.blocks[block];
      const auto &a = room_.links[link_a], &b = room_.links[link_b];
      for (int i = joint.first_row; i < joint.first_row + joint.rows; ++i) {
        BoundedRow row = room_.rows[i];
        row.a = link_a, row.b = link_b, row.block = block;
        row.target = dot(row.linear_a, a.velocity.template as<double>()) + row.angular_a * a.spin +
                     dot(row.linear_b, b.velocity.template as<double>()) + row.angular_b * b.spin;
        if (row.lower == 0) row.target = std::min(row.target, 0.0);
        system_.rows.push_back(row);
      }
      ++block;
    }
  }

  void add_contact_rows() {
    int block = static_cast<int>(room_.taking_part.size()) - 1;
    const ContactConstraint<Real>* last = nullptr;
    for (const StruckPoint<Real>& at : struck_) {
      const ContactConstraint<Real>& c = *at.bounce->contact;
      if (&c != last) ++block;
      last = &c;
      BoundedRow row{.a = room_.blocks[block].first, .b = room_.blocks[block].second};
      const Vec2d n = c.normal.template as<double>(), t{n.y, -n.x};
      row.linear_a = free_of_a(-n, c.locks), row.linear_b = free_of_b(n, c.locks);
      row.angular_a = -double(c.arm_a[at.point]), row.angular_b = c.arm_b[at.point];
      row.target = at.wanted, row.upper = std::numeric_limits<double>::infinity();
      row.block = block;
      system_.rows.push_back(row);
      if (!(c.friction > 0)) continue;
      row.linear_a = free_of_a(-t, c.locks), row.linear_b = free_of_b(t, c.locks);
      row.angular_a = -double(c.arm_tangent_a), row.angular_b = c.arm_tangent_b;
      row.target = c.surface_speed;
      row.lower = -c.friction * at.impulse, row.upper = -row.lower;
      row.impulse = 0;
      system_.rows.push_back(row);
    }
  }

  // Reads the impulses of the contacts' rows, the first of which has the index `row`.
  void read_impulses(std::size_t row) {
    for (StruckPoint<Real>& at : struck_) {
      at.impulse = static_cast<Real>(system_.rows[row++].impulse);
      if (at.bounce->contact->friction > 0) at.friction = static_cast<Real>(system_.rows[row++].impulse);
    }
  }

  // Solves the rows from the velocities before the round.
  void solve() {
    for (std::size_t i = 0; i < room_.links.size(); ++i) {
      system_.bodies[i].velocity = room_.links[i].velocity.template as<double>();
      system_.bodies[i].spin = room_.links[i].spin;
    }
    system_.solve();
    for (std::size_t i = 0; i < room_.links.size(); ++i) {
      SolverBody<Real>& to = motion_[room_.links[i].body];
      if (!is_dynamic(to)) continue;
      to.velocity = system_.bodies[i].velocity.template as<Real>();
      to.angular_velocity = static_cast<Real>(system_.bodies[i].spin);
    }
  }

  // Solves normals without friction first, and then with the bounds of friction that follow from them.
  void exchange() {
    constexpr int kRenewals = 1;  // updates of the bounds on friction; each costs a solution
    const bool rubs = std::any_of(struck_.begin(), struck_.end(), [](const StruckPoint<Real>& at) {
      return at.bounce->contact->friction > 0;
    });
    for (int renewal = 0; renewal <= (rubs ? kRenewals : 0); ++renewal) {
      add_joint_rows();
      const std::size_t first = system_.rows.size();
      add_contact_rows();
      solve();
      read_impulses(first);
    }
    const Real scale = energy_scale(work_before<Real>(struck_), work_of<Real>(motion_, struck_));
    if (scale == 1) return;
    for (StruckPoint<Real>& at : struck_) at.impulse *= scale, at.friction *= scale;
    for (const auto& link : room_.links) {
      SolverBody<Real>& body = motion_[link.body];
      body.velocity = link.velocity + scale * (body.velocity - link.velocity);
      body.angular_velocity = link.spin + scale * (body.angular_velocity - link.spin);
    }
  }

  SolverBody<Real>* motion_;
  Rotation<Real>* rotation_;
  std::span<StruckPoint<Real>> struck_;
  ImpactScratch<Real>& room_;
  BoundedRows& system_;
};

}  // namespace

template <class Real>
void resolve_round(SolverBody<Real>* motion, Rotation<Real>* rotation, Real fastest, int& looks,
                   ImpactScratch<Real>& room) {
  group_struck(motion, room);
  for (StruckPoint<Real>& at : room.struck)
    if (at.bounce->contact->friction > 0) at.sliding = sliding_of(motion, *at.bounce->contact);
  const std::span<StruckPoint<Real>> all(room.struck);
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    while (end < all.size() && all[end].group == all[first].group) ++end;
    const std::span<StruckPoint<Real>> struck = all.subspan(first, end - first);
    if (JointedRound<Real> jointed(motion, rotation, struck, room); jointed.collect()) {
      jointed.resolve();
      looks -= static_cast<int>(struck.size());
    } else {
      exchange(motion, struck, fastest, looks);
      for (const StruckPoint<Real>& at : struck) finish_impact(motion, rotation, at, room);
    }
  }
}

#define PLUMB_FOR(Real) \
  template void resolve_round(SolverBody<Real>*, Rotation<Real>*, Real, int&, ImpactScratch<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
