#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "engine/math/small_rotation.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/world_data.h"

/// Bodies of an island with joints.
namespace plumb {

/// Returns the index of a body among the island's links; adds the body if it is new.
template <class Real>
int link_at(WorldData<Real>& w, JointedIsland<Real>& island, int body) {
  int& index = w.scratch.islands.link_of[body];
  if (index < static_cast<int>(island.links.size()) && island.links[index].body == body) return index;
  index = static_cast<int>(island.links.size());
  const SolverBody<Real>& motion = w.motion[body];
  const BodyRecord<Real>& record = w.bodies[body];
  const double inverse_mass = motion.inverse_mass;
  island.links.push_back({body});
  island.system.bodies.push_back(
      {.inverse_mass = {record.lock_x ? 0 : inverse_mass, record.lock_y ? 0 : inverse_mass},
       .inverse_inertia = motion.inverse_inertia});
  return index;
}

/// Begins an island without links.
template <class Real>
void clear_links(WorldData<Real>& w, JointedIsland<Real>& island) {
  island.links.clear(), island.system.bodies.clear(), island.blocks.clear(), island.block_sizes.clear();
  w.scratch.islands.link_of.resize(
      std::max(w.scratch.islands.link_of.size(), static_cast<std::size_t>(w.bodies.size())));
}

/// Finds the bodies of an island's joints and contacts.
template <class Real>
void find_links(WorldData<Real>& w, JointedIsland<Real>& island) {
  clear_links(w, island);
  const auto add = [&](int a, int b) {
    const int link_a = link_at(w, island, a);
    island.blocks.emplace_back(link_a, link_at(w, island, b));
  };
  for (const int joint : island.joints) {
    const auto [a, b] = w.joint_set.bodies(joint);
    add(a, b);
  }
  for (const ContactConstraint<Real>* c : island.contacts) add(c->body_a, c->body_b);
}

/// Joins groups of links. `Member` is the member of JointedLink that is the lowest link of its group.
template <int JointedLink::*Member>
class LinkGroups {
 public:
  explicit LinkGroups(std::pmr::vector<JointedLink>& links) : links_(links) {
    for (int link = 0; link < static_cast<int>(links.size()); ++link) links[link].*Member = link;
  }
  void join(int a, int b) {
    a = of(a), b = of(b);
    links_[std::max(a, b)].*Member = std::min(a, b);
  }
  /// Stores the lowest link of each link's group.
  void finish() {
    for (int link = 0; link < static_cast<int>(links_.size()); ++link) links_[link].*Member = of(link);
  }

 private:
  int of(int link) const {
    while (links_[link].*Member != link) link = links_[link].*Member;
    return link;
  }
  std::pmr::vector<JointedLink>& links_;
};

/// Groups links that joints connect, and those that joints with three rigid rows connect: contacts between
/// links of such a group have nothing to carry.
template <class Real>
void find_link_groups(WorldData<Real>& w, JointedIsland<Real>& island) {
  LinkGroups<&JointedLink::rigid_group> rigid(island.links);
  LinkGroups<&JointedLink::joint_group> jointed(island.links);
  int ground = kNone;
  for (int link = 0; link < static_cast<int>(island.links.size()); ++link) {
    if (w.is_dynamic(island.links[link].body)) continue;
    if (ground != kNone) jointed.join(ground, link);
    ground = link;
  }
  std::vector<JointSolverRow<Real>>& rows = w.scratch.solver.joint_rows;
  for (std::size_t i = 0; i < island.joints.size(); ++i) {
    const auto [a, b] = island.blocks[i];
    jointed.join(a, b);
    rows.clear();
    w.joint_set.solver_rows(island.joints[i], w.solver_bodies(), rows);
    const auto is_rigid = [](const JointSolverRow<Real>& row) { return row.role == RowRole::Rigid; };
    if (enabled(Switch::RigidGroups) && std::count_if(rows.begin(), rows.end(), is_rigid) >= 3)
      rigid.join(a, b);
  }
  rigid.finish(), jointed.finish();
}

/// Returns the length of the link to which a row's gap is relative, as joint_opening.h defines it, m; 1 for
/// an angle. If the joint is itself a link, `length` is its length, m.
template <class Real>
double link_length(const JointedIsland<Real>& island, const BoundedRow& row, double length) {
  const auto radius = [](const BoundedBody& body, Vec2d linear, double angular) {
    if (!(body.inverse_inertia > 0)) return std::numeric_limits<double>::infinity();
    const double mobility = std::max(body.inverse_mass.x, body.inverse_mass.y) * length_squared(linear);
    return std::sqrt(mobility / body.inverse_inertia + angular * angular);
  };
  const double shorter = std::min(radius(island.system.bodies[row.a], row.linear_a, row.angular_a),
                                  radius(island.system.bodies[row.b], row.linear_b, row.angular_b));
  return std::max(shorter, length);
}

/// Translates and rotates a body within a substep.
template <class Real>
void displace_body(WorldData<Real>& w, int body, Vec2d displacement, double rotation) {
  SolverBody<Real>& motion = w.motion[body];
  motion.delta_position += displacement.template as<Real>();
  if (rotation == 0) return;
  motion.delta_angle += static_cast<Real>(rotation);
  w.rotation[body] = rotated_by(w.rotation[body], static_cast<Real>(rotation));
}

/// Stores the poses of an island's bodies before they are shifted.
template <class Real>
void save_displacements(const WorldData<Real>& w, JointedIsland<Real>& island) {
  for (JointedLink& link : island.links) {
    const SolverBody<Real>& motion = w.motion[link.body];
    link.delta_position = motion.delta_position.template as<double>(), link.delta_angle = motion.delta_angle;
  }
}

/// Moves the bodies of an island by a common fraction of the `displacements` of its system: the largest one
/// at which no body rotates by more than `max_rotation`, rad, or moves by more than that fraction of its
/// extent. Returns the fraction.
template <class Real>
double displace_links(WorldData<Real>& w, const JointedIsland<Real>& island, double max_rotation) {
  double fraction = 1;
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    const BoundedRows::Displacement& s = island.system.displacements[i];
    const double rotation = std::abs(s.rotation), displacement = length(s.translation);
    const double longest = max_rotation * double(w.extents[island.links[i].body]);
    if (rotation * fraction > max_rotation) fraction = max_rotation / rotation;
    if (longest > 0 && displacement * fraction > longest) fraction = longest / displacement;
  }
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    if (!w.is_dynamic(island.links[i].body)) continue;
    const BoundedRows::Displacement& s = island.system.displacements[i];
    displace_body(w, island.links[i].body, fraction * s.translation, fraction * s.rotation);
  }
  return fraction;
}

}  // namespace plumb
