#pragma once

#include "scenarios/truth/parts.h"

/// Free bodies that forces beside their centres push and turn: problems with their bounds.
namespace plumb::scenarios::truth {

inline constexpr double kPush = 1;    ///< s, duration of a world-fixed force
inline constexpr double kWatch = 3;   ///< s, duration of push and free flight, and of a thruster
inline constexpr double kSpins = 10;  ///< s

/// Returns a box that touches nothing, with the inertia of its sides.
Body free_box(std::string name, double mass, double width, double height, Vec2d position);

/// Returns a problem of bodies that are pushed for kPush, one world-fixed force each, in the bodies' order.
Problem pushed(Scene scene);

/// Returns a problem of one body from rest, with one force fixed in it: the angle is alpha t^2/2 and the path
/// an Euler spiral.
Problem thrust(Scene scene);

/// Returns a problem of bodies without forces: everything is conserved.
Problem coasting(Scene scene);

}  // namespace plumb::scenarios::truth
