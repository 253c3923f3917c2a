#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "engine/scene/scene.h"
#include "harness/stress/family.h"
#include "harness/stress/rules.h"

/// Scenes and helpers that several families use.
namespace plumb::extremes {

using namespace harness::stress;

inline constexpr double kGravity = 9.81;  // m/s^2
inline constexpr double kDt = 1.0 / 60;   // s

/// Returns a shape that gives a body its appearance and inertia, but collides with nothing.
inline Shape untouchable(const Geometry& geometry) {
  return {.geometry = geometry, .friction = 0, .filter = {.mask = 0}};
}

/// Returns the number of steps for `seconds`, at least one.
inline long steps_for(double seconds, double dt) { return std::max(1L, std::lround(seconds / dt)); }

/// A tower of `count` boxes with sides of `size`, m, on a floor whose top is at y = `foot.y`. Neighbours
/// touch with zero separation. The floor is the last body.
Scene tower(std::string name, int count, double size, Vec2d foot = {});

/// A thin rod of `length`, m, on a hinge at `pivot`, at `angle`, rad, from straight down. Its mass is
/// length^2 kg/m^2.
Scene pendulum(std::string name, double length, double angle, Vec2d pivot = {});

/// `count` thin rods of 1 m and 1 kg, hinged end to end from the origin, along `direction` (a unit vector).
/// If `tip` > 0, a disc of that mass, kg, is hinged to the end.
Scene rod_chain(std::string name, int count, Vec2d direction, double tip = 0);

/// A trial of a scene at rest. Penetration may be at most 1 % of `size`, m, and displacement at most 5 %; a
/// body displaced by ten sizes has exploded.
Trial resting(Scene scene, double size, double dt, long steps);

/// The exact motion of a scene at rest.
Motion at_rest(const Scene& scene);

}  // namespace plumb::extremes
