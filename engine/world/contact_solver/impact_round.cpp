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
constexpr int kMaxIterations = 40;

// Maximum cost of factorising the rows of a round's joints, in multiplications: some 0.1 ms. Beyond it joints
// react to impacts only in the solver's next iterations, which lose energy.
constexpr double kJointsCost = 2e5;

// Effort of an iteration over one point, in multiplications of BoundedRows: a pass that reads the velocity,
// and one that changes it. Limbs that an impact presses against their limits repeat a round some 1,000 times.
// Besides its solution, a round with joints collects, orders and assembles its rows: some 32 iterations each.
constexpr double kEffortOfPoint = 16, kEffortOfRow = 512;

template <class Real>
void apply_normal(SolverBody<Real>* motion, const ContactConstraint<Real>& c, int i, Real impulse) {
  motion[c.body_a].apply(-impulse * free_of_a(c.normal, c.locks), -impulse * c.arm_a[i]);
  motion[c.body_b].apply(impulse * free_of_b(c.normal, c.locks), impulse * c.arm_b[i]);
}

// Sorts the impact points by groups that share no dynamic body, and keeps their order within a group.
template <class Real>
void group_points(const SolverBody<Real>* motion, ImpactScratch<Real>& scratch) {
  std::vector<ImpactPoint<Real>>& points = scratch.points;
  const int count = static_cast<int>(points.size());
  std::vector<int>&next_in_group = scratch.next_in_group, &last_in_group = scratch.last_in_group;
  next_in_group.assign(points.size(), -1), last_in_group.assign(points.size(), -1);
  const auto find_root = [&](int i) {
    while (points[i].group != i) i = points[i].group = points[points[i].group].group;
    return i;
  };
  for (int i = 0; i < count; ++i) {
    points[i].group = i;
    for (const int body : {points[i].bounce->contact->body_a, points[i].bounce->contact->body_b}) {
      if (!is_dynamic(motion[body])) continue;
      int& at = scratch.point_at[group_of(scratch, body)];
      if (at == -1) at = i;
      const int one = find_root(i), other = find_root(at);
      points[std::max(one, other)].group = std::min(one, other);
    }
  }
  for (int i = 0; i < count; ++i) {
    const int group = points[i].group = find_root(i);
    if (group != i) next_in_group[last_in_group[group]] = i;
    last_in_group[group] = i;
    for (const int body : {points[i].bounce->contact->body_a, points[i].bounce->contact->body_b})
      scratch.point_at[group_of(scratch, body)] = -1;
  }
  scratch.sorted_points.clear();
  for (int i = 0; i < count; ++i)
    for (int k = points[i].group == i ? i : -1; k != -1; k = next_in_group[k])
      append(scratch.sorted_points, points[k]);
  points.swap(scratch.sorted_points);
}

// Returns the relative tangential velocity of a contact's bodies minus the surface speed, m/s.
template <class Real>
Real slip_velocity(const SolverBody<Real>* motion, const ContactConstraint<Real>& c) {
  const SolverBody<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return dot(Vec2<Real>{c.normal.y, -c.normal.x}, b.velocity - a.velocity) +
         c.arm_tangent_b * b.angular_velocity - c.arm_tangent_a * a.angular_velocity - c.surface_speed;
}

template <class Real>
void apply_friction(SolverBody<Real>* motion, const ContactConstraint<Real>& c, Real friction) {
  const Vec2<Real> t{c.normal.y, -c.normal.x};
  motion[c.body_a].apply(-friction * free_of_a(t, c.locks), -friction * c.arm_tangent_a);
  motion[c.body_b].apply(friction * free_of_b(t, c.locks), friction * c.arm_tangent_b);
}

// Returns the work that a round's impulses would do at the velocities before the round, J.
template <class Real>
Real work_before(std::span<const ImpactPoint<Real>> points) {
  Real work = 0;
  for (const ImpactPoint<Real>& at : points)
    work += at.impulse * at.velocity_before + at.friction * at.slip_before;
  return work;
}

// Returns the same work at the current velocities, J.
template <class Real>
Real work_after(const SolverBody<Real>* motion, std::span<const ImpactPoint<Real>> points) {
  Real work = 0;
  for (const ImpactPoint<Real>& at : points) {
    const ContactConstraint<Real>& c = *at.bounce->contact;
    work += at.impulse * velocity_along_normal(motion, c, at.point);
    if (at.friction != 0) work += at.friction * slip_velocity(motion, c);
  }
  return work;
}

// Returns the largest factor, from 0 to 1, by which a round's impulses can be scaled without gaining energy.
// `before`, `after`: their work at the velocities before and after the round, J. Scaled by k they change the
// energy by k (before + k (after - before) / 2): impulses along which the bodies part already can only gain.
template <class Real>
Real energy_scale(Real before, Real after) {
  if (!(before + after > 0)) return 1;
  return before < 0 ? -2 * before / (after - before) : Real(0);
}

// Solves lambda >= 0 with n.v >= target by sequential impulses, and Coulomb's friction with it, such that no
// energy is gained. Friction is solved after the normals; where it rotates bodies, the normals are solved
// again: a box that lands flat then leaves with the same speed at both ends.
template <class Real>
void solve_impacts(SolverBody<Real>* motion, std::span<ImpactPoint<Real>> points, Real max_approach,
                   int& work_left) {
  // Returns true if a normal impulse changes.
  const auto solve_normals = [&] {
    bool changes = false;
    for (ImpactPoint<Real>& at : points) {
      const ContactConstraint<Real>& c = *at.bounce->contact;
      const Real velocity_error = at.target - velocity_along_normal(motion, c, at.point);
      const Real impulse = std::max(at.impulse + c.mass[at.point] * velocity_error, Real(0));
      const Real change = impulse - at.impulse;
      if (std::abs(change) > Real(kConverged) * max_approach * c.mass[at.point]) changes = true;
      apply_normal(motion, c, at.point, change);
      at.impulse = impulse;
    }
    return changes;
  };
  const auto solve_friction = [&] {
    for (ImpactPoint<Real>& at : points) {
      const ContactConstraint<Real>& c = *at.bounce->contact;
      const Real max_friction = c.friction * at.impulse;
      if (!(max_friction > 0) && at.friction == 0) continue;
      const Real friction =
          std::clamp(at.friction - c.tangent_mass * slip_velocity(motion, c), -max_friction, max_friction);
      apply_friction(motion, c, friction - at.friction);
      at.friction = friction;
    }
  };
  bool changes = true, repeat = false;
  for (int iteration = 0; changes && iteration < kMaxIterations && (iteration == 0 || work_left > 0);
       ++iteration) {
    work_left -= static_cast<int>(points.size());
    changes = solve_normals() && points.size() > 1;  // a single point needs no iteration
  }
  for (ImpactPoint<Real>& at : points) repeat = repeat || at.bounce->contact->friction * at.impulse > 0;
  if (repeat) solve_friction();
  for (int iteration = 0; repeat && iteration < kMaxIterations && (iteration == 0 || work_left > 0);
       ++iteration) {
    work_left -= static_cast<int>(points.size());
    repeat = solve_normals() && points.size() > 1;
  }
  const Real scale = energy_scale(work_before<Real>(points), work_after<Real>(motion, points));
  if (scale == 1) return;
  for (ImpactPoint<Real>& at : points) {
    apply_normal(motion, *at.bounce->contact, at.point, (scale - 1) * at.impulse);
    apply_friction(motion, *at.bounce->contact, (scale - 1) * at.friction);
    at.impulse *= scale, at.friction *= scale;
  }
}

template <class Real>
void record_impact(const ImpactPoint<Real>& at) {
  ContactConstraint<Real>& c = *at.bounce->contact;
  if (c.tracking != ImpactTracking::Off) {
    record_approach(c, at.point, at.velocity_before);
    c.max_normal_impulse[at.point] = std::max(c.max_normal_impulse[at.point], at.impulse);
    c.step_impulse += at.impulse;
  }
  at.bounce->has_impact[at.point] = false;
}

// Records an impact and corrects the displacement: impulses act only from the time of impact on, not over the
// whole substep.
template <class Real>
void finish_impact(SolverBody<Real>* motion, Rotation<Real>* rotation, const ImpactPoint<Real>& at,
                   ImpactScratch<Real>& scratch) {
  const ContactConstraint<Real>& c = *at.bounce->contact;
  const Vec2<Real> t{c.normal.y, -c.normal.x};
  const Real friction = at.friction;
  record_impact(at);
  const Vec2<Real> displacement = -at.time * (at.impulse * c.normal + friction * t);
  const auto move_back = [&](int body, Real sign, Vec2<Real> back, Real angular) {
    SolverBody<Real>& moving = motion[body];
    displace(scratch, moving, rotation[body], body, (sign * moving.inverse_mass) * back,
             -sign * at.time * moving.inverse_inertia * angular);
    Real& last = scratch.last[group_of(scratch, body)];
    if (is_dynamic(moving)) last = std::max(last, at.time);
  };
  move_back(c.body_a, -1, free_of_a(displacement, c.locks),
            at.impulse * c.arm_a[at.point] + friction * c.arm_tangent_a);
  move_back(c.body_b, 1, free_of_b(displacement, c.locks),
            at.impulse * c.arm_b[at.point] + friction * c.arm_tangent_b);
}

// Solves the impacts of a group of points in a round, with the joints of their bodies.
template <class Real>
class JointedRound {
 public:
  JointedRound(SolverBody<Real>* motion, Rotation<Real>* rotation, std::span<ImpactPoint<Real>> points,
               ImpactScratch<Real>& scratch)
      : motion_(motion), rotation_(rotation), points_(points), scratch_(scratch), system_(scratch.system) {}

  // Collects the bodies and rows. Returns false if no joint takes part, or if there are too many rows.
  bool collect() {
    if (scratch_.joints.empty()) return false;
    clear();
    for (const ImpactPoint<Real>& at : points_) add_joints(at);
    for (const ImpactPoint<Real>& at : points_) unmark(at);
    if (scratch_.active_joints.empty()) return false;
    const ContactConstraint<Real>* last = nullptr;
    for (const ImpactPoint<Real>& at : points_) {
      const ContactConstraint<Real>& c = *at.bounce->contact;
      if (&c != last) add_block(c.body_a, c.body_b, 0);
      scratch_.sizes.back() += c.friction > 0 ? 2 : 1;
      last = &c;
    }
    return system_.order(scratch_.blocks, scratch_.sizes) <= kJointsCost;
  }

  // Collects the bodies and joints of a group alone. Returns false if there are none, or too many.
  bool collect_group(int group) {
    clear();
    add_joints_of(group);
    return !scratch_.active_joints.empty() && system_.order(scratch_.blocks, scratch_.sizes) <= kJointsCost;
  }

  // Removes from the velocities what the joints forbid.
  void stop_rates() {
    add_joint_rows();
    for (BoundedRow& row : system_.rows) row.target = 0;
    solve();
    add_joint_impulses(1);
  }

  void resolve() {
    solve_impacts();
    for (const typename ImpactScratch<Real>::Link& link : scratch_.links) {
      SolverBody<Real>& moving = motion_[link.body];
      if (!is_dynamic(moving)) continue;
      const int group = group_of(scratch_, link.body);
      const Real time = scratch_.earliest[group];
      displace(scratch_, moving, rotation_[link.body], link.body, -time * (moving.velocity - link.velocity),
               -time * (moving.angular_velocity - link.spin));
      scratch_.last[group] = std::max(scratch_.last[group], time);
    }
    for (const ImpactPoint<Real>& at : points_) record_impact(at);
  }

 private:
  // Adds the joints of a point's bodies, those of each group once.
  void add_joints(const ImpactPoint<Real>& at) {
    for (const int body : {at.bounce->contact->body_a, at.bounce->contact->body_b}) {
      const int group = group_of(scratch_, body);
      if (!is_dynamic(motion_[body]) || scratch_.visited[group]) continue;
      scratch_.visited[group] = 1;
      add_joints_of(group);
    }
  }

  void add_joints_of(int group) {
    for (int i = scratch_.first_joint[group]; i != -1; i = scratch_.joints[i].next) {
      ImpactJoint& joint = scratch_.joints[i];
      if (!joint.rows_ready) scratch_.append_rows(scratch_.world, joint), joint.rows_ready = true;
      if (joint.rows == 0) continue;
      scratch_.active_joints.push_back(i);
      add_block(joint.a, joint.b, joint.rows);
    }
  }

  void clear() {
    scratch_.links.clear(), scratch_.blocks.clear(), scratch_.sizes.clear(), scratch_.active_joints.clear();
    system_.bodies.clear();
  }

  void unmark(const ImpactPoint<Real>& at) {
    for (const int body : {at.bounce->contact->body_a, at.bounce->contact->body_b})
      scratch_.visited[group_of(scratch_, body)] = 0;
  }

  // Returns the index of a body's link, and adds the link if there is none.
  int link_for(int body) {
    if (static_cast<int>(scratch_.link_index.size()) <= body) scratch_.link_index.resize(body + 1);
    int& index = scratch_.link_index[body];
    if (index < static_cast<int>(scratch_.links.size()) && scratch_.links[index].body == body) return index;
    index = static_cast<int>(scratch_.links.size());
    const SolverBody<Real>& from = motion_[body];
    scratch_.links.push_back({body, from.velocity, from.angular_velocity});
    const double inverse_mass = from.inverse_mass;
    system_.bodies.push_back(
        {.inverse_mass = {inverse_mass, inverse_mass}, .inverse_inertia = from.inverse_inertia});
    return index;
  }

  void add_block(int a, int b, int rows) {
    const int link_a = link_for(a);
    scratch_.blocks.emplace_back(link_a, link_for(b));
    scratch_.sizes.push_back(rows);
  }

  // Adds the joints' rows, which must keep their rates from before the round. A limit only stops motion
  // beyond it. If it kept its rate while it opens, it would do work, and two contacts that press it in turn
  // would open it ever faster.
  void add_joint_rows() {
    system_.rows.clear();
    int block = 0;
    for (const int part : scratch_.active_joints) {
      const ImpactJoint& joint = scratch_.joints[part];
      const auto [link_a, link_b] = scratch_.blocks[block];
      const auto &a = scratch_.links[link_a], &b = scratch_.links[link_b];
      for (int i = joint.first_row; i < joint.first_row + joint.rows; ++i) {
        BoundedRow row = scratch_.rows[i];
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
    int block = static_cast<int>(scratch_.active_joints.size()) - 1;
    const ContactConstraint<Real>* last = nullptr;
    for (const ImpactPoint<Real>& at : points_) {
      const ContactConstraint<Real>& c = *at.bounce->contact;
      if (&c != last) ++block;
      last = &c;
      BoundedRow row{.a = scratch_.blocks[block].first, .b = scratch_.blocks[block].second};
      const Vec2d n = c.normal.template as<double>(), t{n.y, -n.x};
      row.linear_a = free_of_a(-n, c.locks), row.linear_b = free_of_b(n, c.locks);
      row.angular_a = -double(c.arm_a[at.point]), row.angular_b = c.arm_b[at.point];
      row.target = at.target, row.upper = std::numeric_limits<double>::infinity();
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
    for (ImpactPoint<Real>& at : points_) {
      at.impulse = static_cast<Real>(system_.rows[row++].impulse);
      if (at.bounce->contact->friction > 0) at.friction = static_cast<Real>(system_.rows[row++].impulse);
    }
  }

  // Adds the impulses of the joints' rows, times `scale`, to their joints.
  void add_joint_impulses(double scale) {
    std::size_t next = 0;
    for (const int part : scratch_.active_joints) {
      ImpactJoint& joint = scratch_.joints[part];
      for (int i = 0; i < joint.rows; ++i, ++next) {
        const BoundedRow& row = system_.rows[next];
        joint.impulse += (scale * row.impulse) * row.linear_b;
        joint.moment += scale * row.impulse * (row.angular_b - cross(joint.arm, row.linear_b));
      }
    }
  }

  // Returns the work that the limits' impulses would do at the velocities before and after the round, J. A
  // limit that opens does work if a contact presses it meanwhile, and two that contradict each other would do
  // it with many times the impulses of the impact.
  std::pair<Real, Real> work_of_limits() const {
    double before = 0, after = 0;
    std::size_t next = 0;
    for (const int part : scratch_.active_joints) {
      for (int i = 0; i < scratch_.joints[part].rows; ++i, ++next) {
        const BoundedRow& row = system_.rows[next];
        if (row.lower != 0) continue;
        const auto &a = scratch_.links[row.a], &b = scratch_.links[row.b];
        before +=
            row.impulse * (dot(row.linear_a, a.velocity.template as<double>()) + row.angular_a * a.spin +
                           dot(row.linear_b, b.velocity.template as<double>()) + row.angular_b * b.spin);
        after += row.impulse * system_.row_velocity(row);
      }
    }
    return {static_cast<Real>(before), static_cast<Real>(after)};
  }

  // Solves the rows from the velocities before the round.
  void solve() {
    for (std::size_t i = 0; i < scratch_.links.size(); ++i) {
      system_.bodies[i].velocity = scratch_.links[i].velocity.template as<double>();
      system_.bodies[i].spin = scratch_.links[i].spin;
    }
    system_.solve();
    for (std::size_t i = 0; i < scratch_.links.size(); ++i) {
      SolverBody<Real>& to = motion_[scratch_.links[i].body];
      if (!is_dynamic(to)) continue;
      to.velocity = system_.bodies[i].velocity.template as<Real>();
      to.angular_velocity = static_cast<Real>(system_.bodies[i].spin);
    }
  }

  // Solves the normals without friction first, and then with the bounds on friction that follow from them.
  void solve_impacts() {
    constexpr int kFrictionUpdates = 1;  // of the bounds on friction; each costs a solve
    const bool has_friction = std::any_of(points_.begin(), points_.end(), [](const ImpactPoint<Real>& at) {
      return at.bounce->contact->friction > 0;
    });
    for (int update = 0; update <= (has_friction ? kFrictionUpdates : 0); ++update) {
      add_joint_rows();
      const std::size_t first = system_.rows.size();
      add_contact_rows();
      solve();
      read_impulses(first);
    }
    const auto [joints_before, joints_after] = work_of_limits();
    const Real scale = energy_scale(work_before<Real>(points_) + joints_before,
                                    work_after<Real>(motion_, points_) + joints_after);
    add_joint_impulses(scale);
    if (scale == 1) return;
    for (ImpactPoint<Real>& at : points_) at.impulse *= scale, at.friction *= scale;
    for (const auto& link : scratch_.links) {
      SolverBody<Real>& body = motion_[link.body];
      body.velocity = link.velocity + scale * (body.velocity - link.velocity);
      body.angular_velocity = link.spin + scale * (body.angular_velocity - link.spin);
    }
  }

  SolverBody<Real>* motion_;
  Rotation<Real>* rotation_;
  std::span<ImpactPoint<Real>> points_;
  ImpactScratch<Real>& scratch_;
  BoundedRows& system_;
};

}  // namespace

template <class Real>
void resolve_round(SolverBody<Real>* motion, Rotation<Real>* rotation, Real max_approach, int& work_left,
                   ImpactScratch<Real>& scratch) {
  group_points(motion, scratch);
  for (ImpactPoint<Real>& at : scratch.points)
    if (at.bounce->contact->friction > 0) at.slip_before = slip_velocity(motion, *at.bounce->contact);
  const std::span<ImpactPoint<Real>> all(scratch.points);
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    while (end < all.size() && all[end].group == all[first].group) ++end;
    const std::span<ImpactPoint<Real>> points = all.subspan(first, end - first);
    if (JointedRound<Real> jointed(motion, rotation, points, scratch); jointed.collect()) {
      const double before = scratch.system.effort;
      jointed.resolve();
      const double effort =
          scratch.system.effort - before + kEffortOfRow * static_cast<double>(scratch.system.rows.size());
      work_left -= static_cast<int>(points.size()) + static_cast<int>(effort / kEffortOfPoint);
    } else {
      solve_impacts(motion, points, max_approach, work_left);
      for (const ImpactPoint<Real>& at : points) finish_impact(motion, rotation, at, scratch);
    }
  }
}

template <class Real>
void stop_joint_rates(SolverBody<Real>* motion, Rotation<Real>* rotation, int group,
                      ImpactScratch<Real>& scratch) {
  if (JointedRound<Real> joints(motion, rotation, {}, scratch); joints.collect_group(group))
    joints.stop_rates();
}

#define PLUMB_FOR(Real)                                                                              \
  template void resolve_round(SolverBody<Real>*, Rotation<Real>*, Real, int&, ImpactScratch<Real>&); \
  template void stop_joint_rates(SolverBody<Real>*, Rotation<Real>*, int, ImpactScratch<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
