#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "engine/precise/precise.h"

namespace plumb {

constexpr double kPi = 3.141592653589793238;

/// Advances by `steps` steps and returns every body's state.
inline std::vector<BodyState> advance(Driver& driver, std::size_t bodies, int steps) {
  for (int i = 0; i < steps; ++i) driver.step();
  std::vector<BodyState> states(bodies);
  driver.read(states);
  return states;
}

/// The states after `steps` steps of `precise`.
inline std::vector<BodyState> run(const Scene& scene, int steps, const Precise& precise = {}) {
  return advance(*make_precise_driver(scene, precise, {}), scene.bodies.size(), steps);
}

inline Body ball(const std::string& name, Vec2d position, Vec2d velocity = {}, double mass = 1,
                 double radius = 0.5) {
  Body body{.name = name, .position = position, .velocity = velocity, .mass = mass};
  body.shapes = {{.geometry = Circle{radius}, .friction = 0, .restitution = 1}};
  return body;
}

/// N rods of length 1 and mass 1 from the origin along x, the first one held there.
inline Scene rods(int n) {
  Scene scene{.name = "rods"};
  for (int i = 0; i < n; ++i) {
    scene.bodies.push_back(
        {.name = "rod" + std::to_string(i), .position = {i + 0.5, 0}, .mass = 1, .inertia = 1.0 / 12});
    scene.joints.push_back(RevoluteJoint{"joint" + std::to_string(i),
                                         i == 0 ? std::string(kWorld) : "rod" + std::to_string(i - 1),
                                         "rod" + std::to_string(i),
                                         {i == 0 ? 0.0 : 0.5, 0},
                                         {-0.5, 0},
                                         false});
  }
  return scene;
}

inline Vec2d rod_end(const BodyState& rod, double along) {
  return rod.position + along * Vec2d{std::cos(rod.angle), std::sin(rod.angle)};
}

/// Kinetic and potential energy of rods, and how far apart their ends are.
struct RodsCheck {
  double kinetic = 0, energy = 0, gap = 0;
};

inline RodsCheck check_rods(const std::vector<BodyState>& states) {
  RodsCheck check;
  Vec2d end{};
  for (const BodyState& s : states) {
    check.kinetic += length_squared(s.velocity) / 2 + s.angular_velocity * s.angular_velocity / 24;
    check.energy += 9.81 * s.position.y;
    check.gap = std::max(check.gap, std::sqrt(length_squared(rod_end(s, -0.5) - end)));
    end = rod_end(s, 0.5);
  }
  check.energy += check.kinetic;
  return check;
}

}  // namespace plumb
