#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Returns the speed with which a contact slides in the last solution, m/s.
template <class Real>
double slip_of(const JointedIsland<Real>& island, const FrictionCone<Real>& cone, bool midpoint) {
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
  return std::abs(sliding - double(c.surface_speed));
}

/// Makes a cone's rows for another slip. Returns true if this changes the solution.
template <class Real>
bool set_slip(JointedIsland<Real>& island, FrictionCone<Real>& cone, double slip, bool midpoint) {
  // Tolerated error of a velocity along the normal, as a fraction of the largest one. Contacts that stick
  // have none, because their slip is 0 at first. Contacts that keep sliding begin with the slip of the last
  // substep. At 1e-3 a drum of bodies takes 40 % more instructions, at 1e-5 57 %.
  constexpr double kTolerance = 1e-2;
  bool changed = false;
  const double change = cone.friction * (slip - cone.slip) * (midpoint ? 2 : 1);
  for (int i = cone.first; i < cone.first + cone.count; ++i) {
    BoundedRow& row = island.system.rows[i];
    row.target -= change;
    changed = changed || (row.lower < row.upper && island.system.is_significant(i, change, kTolerance));
  }
  cone.slip = slip;
  return changed;
}

/// Makes the rows of friction cones for the slip that was found. Returns true if a slip has changed so much
/// that another solve is needed. For a single contact, the slip u that results depends on the slip s for
/// which its rows were made by du/ds = mu^2 k / (1 + mu^2 k), with k the mobility along its tangent over that
/// along its normal. So changing s by (1 + mu^2 k) (u - s) leads to u = s at once. Joints and other contacts
/// change du/ds, on a wedge that is nearly self-locking to below -1, where equal steps never end: later
/// changes follow the secant through the last two.
template <class Real>
bool update_slips(JointedIsland<Real>& island, bool midpoint) {
  bool changed = false;
  for (FrictionCone<Real>& cone : island.cones) {
    const double missing = slip_of(island, cone, midpoint) - cone.slip;
    // Follows the secant if the last change was too large. Other cones change as well, and rows
    // reach bounds: with 1/16 in place of 1/4 half as many again of a crowd's islands stay unsolved.
    if (missing * cone.last_missing < 0)
      cone.gain = std::max(cone.last_step / (cone.last_missing - missing), cone.gain / 4);
    const double slip = std::max(cone.slip + cone.gain * missing, 0.0);
    cone.last_missing = missing, cone.last_step = slip - cone.slip;
    changed = set_slip(island, cone, slip, midpoint) || changed;
  }
  return changed;
}

/// Sets the bounds of a cone's rows.
template <class Real>
void set_upper(JointedIsland<Real>& island, const FrictionCone<Real>& cone, double upper) {
  for (int i = cone.first; i < cone.first + cone.count; ++i) {
    island.system.rows[i].upper = upper;
    island.system.rows[i].state = BoundedRow::kLower;
  }
}

/// Takes all impulses from the contacts that may jam. Where joints keep two bodies from parting, the relaxed
/// law, by which what slides also parts, lets nothing slide: the contact and the joints press against each
/// other with what friction needs, out of nothing. A contact that jams has the slip 0 and the impulse at an
/// edge of its cone. Returns true if there are any.
template <class Real>
bool release_jammed(JointedIsland<Real>& island) {
  bool any = false;
  for (FrictionCone<Real>& cone : island.cones) {
    if (!cone.guided) continue;
    double at_edge[2] = {0, 0};
    bool open = false;
    for (int i = cone.first; i < cone.first + cone.count; ++i) {
      at_edge[(i - cone.first) % 2] += island.system.rows[i].impulse;
      open = open || island.system.rows[i].lower < island.system.rows[i].upper;
    }
    constexpr double kRounding = 1e-6;  // of an impulse that is 0
    if (!open || !(std::max(at_edge[0], at_edge[1]) > 0) ||
        std::min(at_edge[0], at_edge[1]) > kRounding * std::max(at_edge[0], at_edge[1]))
      continue;
    cone.released = any = true;
    cone.held_slip = cone.slip;
    set_upper(island, cone, 0);
  }
  return any;
}

/// Gives the released contacts their impulses back, at the slips that they have without them.
template <class Real>
void set_released_slips(JointedIsland<Real>& island, bool midpoint) {
  for (FrictionCone<Real>& cone : island.cones) {
    if (!cone.released) continue;
    set_slip(island, cone, slip_of(island, cone, midpoint), midpoint);
    cone.last_missing = cone.last_step = 0;
    set_upper(island, cone, std::numeric_limits<double>::infinity());
  }
}

/// Returns the released contacts to the slips that they had before.
template <class Real>
void hold_released(JointedIsland<Real>& island, bool midpoint) {
  for (FrictionCone<Real>& cone : island.cones)
    if (cone.released) set_slip(island, cone, cone.held_slip, midpoint);
}

}  // namespace plumb
