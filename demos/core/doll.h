#pragma once

#include "demos/core/demo.h"

/// A figure of a head, a torso, arms and legs, built in two ways: 60 kg, 1.7 m, facing to the right. `hip`:
/// m, its middle; `group`: > 0, parts of one figure do not collide.
namespace plumb::demos {

/// Adds rigid parts ("head", "torso", "upper arm", ...) joined by hinges with limits.
void add_jointed_doll(DemoWorld& world, Vec2d hip, int group);

/// Adds points ("head", "shoulder", "hip", ...) joined by sticks (Jakobsen, 2001). Sticks with a minimum
/// length only replace the limits of neck, elbows and knees.
void add_stick_doll(DemoWorld& world, Vec2d hip, int group);

/// Adds a stick between the centres of two bodies, with their present distance as its length. If `least` is
/// below 1, it only keeps the distance above that fraction of the length.
JointId add_stick(DemoWorld& world, BodyId a, BodyId b, double least = 1);

}  // namespace plumb::demos
