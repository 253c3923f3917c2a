#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/world/joint_solver/hinge_tree.h"

/// Energy of a hinge tree in a step. A load may demand more inertia of a link than it has
/// (`TreeLink::demand`), and impulses that such inertias share out may gain energy. So a tree's energy is
/// compared with the work of the forces, and what is too much is taken from its relative motion.
namespace plumb {

/// Returns the velocity of the point that holds a tree, or 0 if none does.
inline Vec2d velocity_of_hold(std::span<const TreeLink> tree) {
  const TreeLink& root = tree[0];
  return root.moves ? Vec2d{} : root.velocity + cross(root.spin, tree[1].parent_lever);
}

inline double mass_of(const TreeLink& link) { return link.moves ? 1 / link.inverse_mass : 0; }

inline double inertia_of(const TreeLink& link) {
  return link.moves && link.inverse_inertia > 0 ? 1 / link.inverse_inertia : 0;
}

/// Returns the kinetic energy relative to the velocity `frame`, J.
inline double energy_of(std::span<const TreeLink> tree, Vec2d frame) {
  double sum = 0;
  for (const TreeLink& link : tree)
    sum += mass_of(link) * length_squared(link.velocity - frame) + inertia_of(link) * link.spin * link.spin;
  return 0.5 * sum;
}

/// Returns the work of the forces of a part of a substep over its motion, J.
inline double work_of(std::span<const TreeLink> tree, Vec2d frame) {
  double sum = 0;
  for (const TreeLink& link : tree)
    sum +=
        mass_of(link) * dot(link.kick, link.velocity - frame) + inertia_of(link) * link.spin_kick * link.spin;
  return sum;
}

/// A motion of all bodies as one.
struct RigidMotion {
  Vec2d centre{};    ///< m, of mass
  Vec2d velocity{};  ///< m/s, there
  double spin = 0;   ///< rad/s
};

/// Returns the motion as one rigid body with a free tree's momentum and angular momentum; of a tree that is
/// held, that of its hold. Stores the bodies' places in `next_gap`, m.
inline RigidMotion rigid_motion(std::span<TreeLink> tree) {
  RigidMotion out{.velocity = velocity_of_hold(tree)};
  if (!tree[0].moves) return out;
  double mass = 0;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    TreeLink& link = tree[i];
    link.next_gap = i == 0 ? Vec2d{} : tree[link.parent].next_gap + (link.parent_lever - link.lever);
    mass += mass_of(link);
    out.centre += mass_of(link) * link.next_gap, out.velocity += mass_of(link) * link.velocity;
  }
  out.centre *= 1 / mass, out.velocity *= 1 / mass;
  double inertia = 0, momentum = 0;
  for (const TreeLink& link : tree) {
    if (link.inverse_inertia == 0) {  // the others cannot rotate with it
      out.spin = link.spin;
      return out;
    }
    const Vec2d arm = link.next_gap - out.centre;
    inertia += mass_of(link) * length_squared(arm) + inertia_of(link);
    momentum += mass_of(link) * cross(arm, link.velocity - out.velocity) + inertia_of(link) * link.spin;
  }
  out.spin = momentum / inertia;
  return out;
}

/// Reduces the bodies' relative motion until the energy is at most `most`, J. Hinges stay closed, and a free
/// tree keeps its momentum and angular momentum.
inline void limit_energy(std::span<TreeLink> tree, Vec2d frame, double most) {
  if (!(energy_of(tree, frame) > most)) return;
  const RigidMotion rigid = rigid_motion(tree);
  double common = 0, own = 0;
  const auto velocity_at = [&](const TreeLink& link) {
    return rigid.velocity + cross(rigid.spin, link.next_gap - rigid.centre);
  };
  for (const TreeLink& link : tree) {
    const Vec2d v = tree[0].moves ? velocity_at(link) : rigid.velocity;
    const double spin = link.spin - rigid.spin;
    common += mass_of(link) * length_squared(v - frame) + inertia_of(link) * rigid.spin * rigid.spin;
    own += mass_of(link) * length_squared(link.velocity - v) + inertia_of(link) * spin * spin;
  }
  const double scale = own > 0 ? std::sqrt(std::max(2 * most - common, 0.0) / own) : 0;
  if (!(scale < 1)) return;
  for (TreeLink& link : tree) {
    if (!link.moves) continue;
    const Vec2d v = tree[0].moves ? velocity_at(link) : rigid.velocity;
    link.velocity = v + scale * (link.velocity - v);
    link.spin = rigid.spin + scale * (link.spin - rigid.spin);
  }
}

}  // namespace plumb
