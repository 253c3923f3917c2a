#pragma once

#include "demos/core/demo.h"

/// A figure of a head, a torso, arms and legs, built in two ways: 60 kg, 1.7 m, facing to the right. `hip`:
/// m, its middle; `group`: > 0, parts of one figure do not touch each other.
namespace plumb::demos {

/// Rigid parts ("head", "torso", "upper arm", ...) that hinges with limits hold together.
void add_jointed_doll(DemoWorld& world, Vec2d hip, int group);

/// Points ("head", "shoulder", "hip", ...) that sticks hold apart (Jakobsen, 2001). Sticks that may be
/// longer, and not shorter, stand for the limits of neck, elbows and knees.
void add_stick_doll(DemoWorld& world, Vec2d hip, int group);

/// A stick between the middles of two bodies, of the length that they are apart; with `least` only to keep
/// them from coming nearer than this share of it.
JointId add_stick(DemoWorld& world, BodyId a, BodyId b, double least = 1);

}  // namespace plumb::demos
