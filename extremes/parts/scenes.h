#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "engine/scene/scene.h"
#include "harness/stress/family.h"
#include "harness/stress/rules.h"

/// What families share: the scenes that they stretch.
namespace plumb::extremes {

using namespace harness::stress;

inline constexpr double kGravity = 9.81;  // m/s^2
inline constexpr double kDt = 1.0 / 60;   // s

/// A shape that gives a body its looks and its inertia, and touches nothing.
inline Shape untouchable(const Geometry& geometry) {
  return {.geometry = geometry, .friction = 0, .filter = {.mask = 0}};
}

/// The number of steps for `seconds`, at least one.
inline long steps_for(double seconds, double dt) { return std::max(1L, std::lround(seconds / dt)); }

/// A tower of `count` boxes with sides of `size`, m, on a floor whose top is at y = `foot.y`: everything
/// touches, nothing presses. The floor is the last body.
Scene tower(std::string name, int count, double size, Vec2d foot = {});

/// A thin rod of `length`, m, from a hinge at `pivot`, at `angle` from straight down; its mass is length^2
/// kg/m^2.
Scene pendulum(std::string name, double length, double angle, Vec2d pivot = {});

/// `count` thin rods of 1 m and 1 kg, hinged end to end from the origin, along `direction` (a unit vector);
/// where `tip` > 0 a disc of that mass, kg, is hinged to the end.
Scene rod_chain(std::string name, int count, Vec2d direction, double tip = 0);

/// The scene stays as it is: nothing may lie in another shape deeper than a hundredth of `size`, m, or leave
/// its place by more than a twentieth; what is ten sizes away has exploded.
Trial resting(Scene scene, double size, double dt, long steps);

/// The exact motion of a scene at rest.
Motion at_rest(const Scene& scene);

}  // namespace plumb::extremes
