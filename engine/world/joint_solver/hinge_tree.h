#pragma once

#include <span>

#include "engine/math/vec2.h"

/// Articulated bodies: trees of bodies joined by plain hinges, each integrated as a whole by RATTLE
/// (Andersen, Journal of Computational Physics 52, 1983). The first impulses of a substep close all hinges at
/// the new positions, to rounding; those at its end correct the velocities. The method is symmetric and of
/// second order: a pendulum's energy oscillates by a fraction of (h w)^2 and does not decay. Each system is
/// solved in one pass to the root and one back (Featherstone, The Calculation of Robot Dynamics using
/// Articulated-Body Inertias, 1983). Trees may branch. Any mass ratio works, because only positive terms are
/// added. All in double: float would lose a little energy in every step.
namespace plumb {

/// A symmetric 2x2 matrix, kg.
struct ArticulatedMass {
  double xx = 0, xy = 0, yy = 0;
  Vec2d times(Vec2d v) const { return {xx * v.x + xy * v.y, xy * v.x + yy * v.y}; }
};

/// A body, and the hinge that joins it to its parent.
struct ArticulatedLink {
  int body = -1;
  int joint = -1;                   ///< its hinge; the root has none: -1
  int parent = 0;                   ///< index of the parent, from the tree's first link
  bool is_dynamic = true;           ///< false: a static or kinematic body, only at the root
  double sign = 1;                  ///< -1 if the joint's body b is the parent
  Vec2d anchor{}, parent_anchor{};  ///< m, of its hinge from the two centres of mass, in the bodies' frames
  double radius_squared = 0;        ///< m^2, from the centre of mass to the farthest hinge
  double arm_scale_squared = 1;     ///< m^2, of its hinge's arms: scale of gaps

  // Input of a step.
  double inverse_mass = 0, inverse_inertia = 0;  ///< 1/kg, 1/(kg m^2); the latter 0: does not rotate
  Vec2d velocity_increment{};                    ///< m/s in a substep
  double spin_increment = 0, damping_factor = 1, spin_damping_factor = 1;
  Rotation<double> rotation{};
  Vec2d velocity{};  ///< m/s
  double spin = 0;   ///< rad/s
  Vec2d gap{};       ///< m, own anchor minus the parent's
  Vec2d impulse{};   ///< N s, on the body by its hinge, in a substep

  // Results.
  Vec2d step_impulse{};    ///< N s, on the body by its hinge, in the whole step
  Vec2d delta_position{};  ///< m
  double delta_angle = 0;  ///< rad

  // Intermediate values.
  Vec2d velocity_before{};                ///< m/s, to undo a motion that failed
  double spin_before = 0;                 ///< rad/s
  double inertia = 0;                     ///< kg m^2, raised to the required one
  double required_inertia = 0;            ///< kg m^2, to follow the load's geometric stiffness
  double added_fraction = 0;              ///< fraction of the inertia about the hinge that was added
  Vec2d arm{}, parent_arm{};              ///< m, anchors from the centres of mass
  Vec2d lever{}, parent_lever{};          ///< m, the same to the middle of the gap; impulses act there
  Vec2d from_parent{};                    ///< m, of its hinge from the parent's own
  Vec2d target_gap{}, predicted_gap{};    ///< m, after the substep
  double sine = 0, cosine_minus_one = 0;  ///< of the rotation in the substep
  ArticulatedMass mass{};                 ///< of the subtree, at its hinge
  Vec2d coupling{};                       ///< kg m, of the hinge's velocity and the spin
  double hinge_inertia = 0;               ///< kg m^2, about the hinge; its inverse after assembly
  Vec2d target_rate{};                    ///< m/s, velocity change wanted at the hinge
  Vec2d bias_impulse{};                   ///< N s, Featherstone's bias force
  double angular_bias_impulse = 0;        ///< N m s
  Vec2d hinge_change{};                   ///< m/s, of the hinge
  double spin_change = 0;                 ///< rad/s
  Vec2d impulse_change{};                 ///< N s
  Vec2d accumulated_impulse{};            ///< N s, in this substep
};

/// Integrates a tree, parents before children, through `substeps` substeps of `h`, s. Divides substeps in
/// which a body would rotate too far. Does not allocate.
void integrate_tree(std::span<ArticulatedLink> tree, double h, int substeps);

}  // namespace plumb
