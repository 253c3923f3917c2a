#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/world/joint_solver/hinge_tree.h"

/// Energy of a hinge tree in a step. Solving with raised inertias (`ArticulatedLink::required_inertia`) may
/// gain energy. So a tree's energy is compared with the work of the forces, and its relative motion is scaled
/// down to remove the excess.
namespace plumb {

/// Returns the velocity of a tree's fixed point at its base, or 0 if its root is dynamic.
inline Vec2d base_velocity(std::span<const ArticulatedLink> tree) {
  const ArticulatedLink& root = tree[0];
  return root.is_dynamic ? Vec2d{} : root.velocity + cross(root.spin, tree[1].parent_lever);
}

inline double mass_of(const ArticulatedLink& link) { return link.is_dynamic ? 1 / link.inverse_mass : 0; }

inline double inertia_of(const ArticulatedLink& link) {
  return link.is_dynamic && link.inverse_inertia > 0 ? 1 / link.inverse_inertia : 0;
}

/// Returns the kinetic energy relative to the velocity `frame`, J.
inline double kinetic_energy(std::span<const ArticulatedLink> tree, Vec2d frame) {
  double sum = 0;
  for (const ArticulatedLink& link : tree)
    sum += mass_of(link) * length_squared(link.velocity - frame) + inertia_of(link) * link.spin * link.spin;
  return 0.5 * sum;
}

/// Returns the work of the forces of a part of a substep over its motion, J.
inline double work_of(std::span<const ArticulatedLink> tree, Vec2d frame) {
  double sum = 0;
  for (const ArticulatedLink& link : tree)
    sum += mass_of(link) * dot(link.velocity_increment, link.velocity - frame) +
           inertia_of(link) * link.spin_increment * link.spin;
  return sum;
}

/// A motion of all bodies as one.
struct RigidMotion {
  Vec2d centre{};    ///< m, of mass
  Vec2d velocity{};  ///< m/s, there
  double spin = 0;   ///< rad/s
};

/// Returns the rigid motion with a free tree's momentum and angular momentum; for a tree with a fixed base,
/// the velocity of the base. Stores the positions of the bodies, m, in `predicted_gap`.
inline RigidMotion rigid_motion(std::span<ArticulatedLink> tree) {
  RigidMotion out{.velocity = base_velocity(tree)};
  if (!tree[0].is_dynamic) return out;
  double mass = 0;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    ArticulatedLink& link = tree[i];
    link.predicted_gap =
        i == 0 ? Vec2d{} : tree[link.parent].predicted_gap + (link.parent_lever - link.lever);
    mass += mass_of(link);
    out.centre += mass_of(link) * link.predicted_gap, out.velocity += mass_of(link) * link.velocity;
  }
  out.centre *= 1 / mass, out.velocity *= 1 / mass;
  double inertia = 0, momentum = 0;
  for (const ArticulatedLink& link : tree) {
    if (link.inverse_inertia == 0) {  // the others cannot rotate with it
      out.spin = link.spin;
      return out;
    }
    const Vec2d arm = link.predicted_gap - out.centre;
    inertia += mass_of(link) * length_squared(arm) + inertia_of(link);
    momentum += mass_of(link) * cross(arm, link.velocity - out.velocity) + inertia_of(link) * link.spin;
  }
  out.spin = momentum / inertia;
  return out;
}

/// Reduces the bodies' relative motion until the energy is at most `max_energy`, J. Hinges stay closed, and a
/// free tree keeps its momentum and angular momentum.
inline void limit_energy(std::span<ArticulatedLink> tree, Vec2d frame, double max_energy) {
  if (!(kinetic_energy(tree, frame) > max_energy)) return;
  const RigidMotion rigid = rigid_motion(tree);
  double common = 0, relative = 0;
  const auto velocity_at = [&](const ArticulatedLink& link) {
    return rigid.velocity + cross(rigid.spin, link.predicted_gap - rigid.centre);
  };
  for (const ArticulatedLink& link : tree) {
    const Vec2d v = tree[0].is_dynamic ? velocity_at(link) : rigid.velocity;
    const double spin = link.spin - rigid.spin;
    common += mass_of(link) * length_squared(v - frame) + inertia_of(link) * rigid.spin * rigid.spin;
    relative += mass_of(link) * length_squared(link.velocity - v) + inertia_of(link) * spin * spin;
  }
  const double scale = relative > 0 ? std::sqrt(std::max(2 * max_energy - common, 0.0) / relative) : 0;
  if (!(scale < 1)) return;
  for (ArticulatedLink& link : tree) {
    if (!link.is_dynamic) continue;
    const Vec2d v = tree[0].is_dynamic ? velocity_at(link) : rigid.velocity;
    link.velocity = v + scale * (link.velocity - v);
    link.spin = rigid.spin + scale * (link.spin - rigid.spin);
  }
}

}  // namespace plumb
