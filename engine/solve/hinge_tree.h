#pragma once

#include <span>

#include "engine/math/vec2.h"

/// Trees of bodies that plain hinges hold, each moved as one mechanism by RATTLE (Andersen, Journal of
/// Computational Physics 52, 1983): the impulses that are found in a substep close all hinges where bodies
/// arrive, to rounding, and those at its end make velocities fit. The method is symmetric and of second
/// order: a pendulum's energy comes and goes by a share of (h w)^2, and is not used up. Each system is solved
/// in one pass to the root and one back (Featherstone, The Calculation of Robot Dynamics using
/// Articulated-Body Inertias, 1983), for any number of branches, whatever the masses: nothing but positive
/// terms are added up. All is in double: float would lose a little energy in every step.
namespace plumb {

/// A symmetric 2x2 matrix, kg.
struct HingeMass {
  double xx = 0, xy = 0, yy = 0;
  Vec2d times(Vec2d v) const { return {xx * v.x + xy * v.y, xy * v.x + yy * v.y}; }
};

/// A body, and the hinge that holds it to the one before it on the way to the root.
struct TreeLink {
  int body = -1;
  int joint = -1;                   ///< its hinge; the root has none: -1
  int parent = 0;                   ///< place of what holds it, from the tree's first link
  bool moves = true;                ///< false: the root alone, a body that does not give way
  double sign = 1;                  ///< -1 where the joint's body b is the parent
  Vec2d anchor{}, parent_anchor{};  ///< m, of its hinge from the two centres of mass, in the bodies' frames
  double reach_squared = 0;         ///< m^2, from the centre of mass to its farthest hinge
  double span_squared = 1;          ///< m^2, of its hinge's arms: what gaps are measured by

  // What it starts with in a step.
  double inverse_mass = 0, inverse_inertia = 0;  ///< 1/kg, 1/(kg m^2); the latter 0: does not turn
  Vec2d kick{};                                  ///< m/s in a substep
  double spin_kick = 0, keep = 1, keep_spin = 1;
  Rotation<double> rotation{};
  Vec2d velocity{};  ///< m/s
  double spin = 0;   ///< rad/s
  Vec2d gap{};       ///< m, own anchor less the parent's
  Vec2d impulse{};   ///< N s, on the body by its hinge, in a substep

  // What comes of it.
  Vec2d moved{};      ///< m
  double turned = 0;  ///< rad

  // On the way.
  double inertia = 0;                ///< kg m^2, with what the load adds
  double demand = 0;                 ///< kg m^2, that the load asks for
  double excess = 0;                 ///< share of the inertia about the hinge that the load made
  Vec2d arm{}, parent_arm{};         ///< m, anchors from the centres of mass
  Vec2d lever{}, parent_lever{};     ///< m, the same to the middle of the gap, where impulses act
  Vec2d from_parent{};               ///< m, of its hinge from the parent's own
  Vec2d open{}, next_gap{};          ///< m, left open in the substep; where bodies would arrive
  double sine = 0, less_cosine = 0;  ///< of the turn in the substep; cosine - 1
  HingeMass mass{};                  ///< of all that hangs on the hinge, as it answers there
  Vec2d coupling{};                  ///< kg m, of the hinge's velocity and the spin
  double turning = 0;                ///< kg m^2, about the hinge; once it is done, its inverse
  Vec2d rate{};                      ///< m/s, asked for
  Vec2d pull{};                      ///< N s
  double twist = 0;                  ///< N m s
  Vec2d change{};                    ///< m/s, found for the hinge
  double spin_change = 0;            ///< rad/s
  Vec2d change_impulse{};            ///< N s
  Vec2d found{};                     ///< N s, in this substep so far
};

/// Moves a tree, parents before children, through `substeps` substeps of `h`, s. Substeps in which a body
/// would turn too far are made smaller. Does not allocate.
void move_tree(std::span<TreeLink> tree, double h, int substeps);

}  // namespace plumb
