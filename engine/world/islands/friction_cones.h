#pragma once

#include <algorithm>
#include <cmath>

#include "engine/world/world_data.h"

/// Friction of the contacts of jointed islands: each point has one row along each edge of its friction cone.
/// See docs/decisions/jointed-islands.md. Only jointed_islands.cpp uses it.
namespace plumb {

/// Impulses along the edges (rays) n + mu t and n - mu t of a friction cone, for each point.
struct FrictionRays {
  double impulse[2][2] = {};
};

/// Returns the ray impulses that are equivalent to a contact's impulses. Two points have four rays for three
/// impulses: one of the rays gets no impulse, so that the rows do not depend on each other.
inline FrictionRays rays_of(const ContactImpulses& c, double friction) {
  FrictionRays out;
  if (!(friction > 0)) return out;
  const double normal[2] = {std::max(c.normal[0], 0.0), std::max(c.normal[1], 0.0)};
  const int small = normal[0] <= normal[1] ? 0 : 1, large = 1 - small;
  const double sideways = c.tangent / friction;
  const double at_small = std::copysign(normal[small], sideways);
  const double at_large = std::clamp(sideways - at_small, -normal[large], normal[large]);
  out.impulse[small][0] = 0.5 * (normal[small] + at_small);
  out.impulse[small][1] = 0.5 * (normal[small] - at_small);
  out.impulse[large][0] = 0.5 * (normal[large] + at_large);
  out.impulse[large][1] = 0.5 * (normal[large] - at_large);
  return out;
}

/// Makes the rows of friction cones for the slip that was found. Returns true if a slip has changed so much
/// that another solve is needed. For a single contact, the slip u that results depends on the slip s for
/// which its rows were made by du/ds = mu^2 k / (1 + mu^2 k), with k the mobility along its tangent over that
/// along its normal. So changing s by (1 + mu^2 k) (u - s) leads to u = s at once. Joints and other contacts
/// change du/ds, on a wedge that is nearly self-locking to below -1, where equal steps never end: later
/// changes follow the secant through the last two.
template <class Real>
bool update_slips(JointedIsland<Real>& island, bool midpoint) {
  // Tolerated error of a velocity along the normal, as a fraction of the largest one. Contacts that stick
  // have none, because their slip is 0 at first. Contacts that keep sliding begin with the slip of the last
  // substep. At 1e-3 a drum of bodies takes 40 % more instructions, at 1e-5 57 %.
  constexpr double kTolerance = 1e-2;
  bool changed = false;
  for (FrictionCone<Real>& cone : island.cones) {
    const ContactConstraint<Real>& c = *cone.contact;
    const auto [link_a, link_b] = island.blocks[cone.block];
    const BoundedBody &a = island.system.bodies[link_a], &b = island.system.bodies[link_b];
    const JointedLink &before_a = island.links[link_a], &before_b = island.links[link_b];
    const Vec2d t{double(c.normal.y), -double(c.normal.x)};
    const auto along = [&](Vec2d velocity, double spin_a, double spin_b) {
      return dot(t, velocity) + double(c.arm_tangent_b) * spin_b - double(c.arm_tangent_a) * spin_a;
    };
    double sliding = along(b.velocity - a.velocity, a.spin, b.spin);
    if (midpoint)
      sliding = 0.5 * (sliding + along(before_b.start_velocity - before_a.start_velocity, before_a.start_spin,
                                       before_b.start_spin));
    const double missing = std::abs(sliding - double(c.surface_speed)) - cone.slip;
    // Follows the secant if the last change was too large. Other cones change as well, and rows
    // reach bounds: with 1/16 in place of 1/4 half as many again of a crowd's islands stay unsolved.
    if (missing * cone.last_missing < 0)
      cone.gain = std::max(cone.last_step / (cone.last_missing - missing), cone.gain / 4);
    const double slip = std::max(cone.slip + cone.gain * missing, 0.0);
    cone.last_missing = missing, cone.last_step = slip - cone.slip;
    const double change = cone.friction * cone.last_step * (midpoint ? 2 : 1);
    for (int i = cone.first; i < cone.first + cone.count; ++i) {
      BoundedRow& row = island.system.rows[i];
      row.target -= change;
      changed = changed || (row.lower < row.upper && island.system.is_significant(i, change, kTolerance));
    }
    cone.slip = slip;
  }
  return changed;
}

}  // namespace plumb
