#pragma once

#include <cmath>
#include <string>

#include "engine/driver/driver.h"
#include "tests/precise/support.h"

namespace plumb {

inline Body block(const std::string& name, Vec2d position, double width, double height, double friction,
                  double restitution = 0) {
  Body body{.name = name, .position = position};
  body.shapes = {{.geometry = Box{width, height}, .friction = friction, .restitution = restitution}};
  return body;
}

/// Its top is at y = 0.
inline Body ground(double friction, double restitution = 0) {
  Body body = block("ground", {0, -0.5}, 100, 1, friction, restitution);
  body.type = BodyType::Static;
  return body;
}

inline Body disc(const std::string& name, Vec2d position, Vec2d velocity, double radius, double friction,
                 double restitution = 0) {
  Body body = ball(name, position, velocity, 1, radius);
  body.shapes[0].friction = friction;
  body.shapes[0].restitution = restitution;
  return body;
}

/// A uniform rod of length 2 and mass 1 whose line is the body's x axis: the long side of a box that lies
/// above it.
inline Body rod_on_a_box(const std::string& name, Vec2d position, double angle, double friction,
                         double restitution = 0) {
  Body body{.name = name, .position = position, .angle = angle, .inertia = 1.0 / 3};
  body.shapes = {
      {.geometry = Box{2, 0.01}, .position = {0, 0.005}, .friction = friction, .restitution = restitution}};
  return body;
}

/// Gravity as on a plane at `angle` that goes down to the right.
inline Vec2d gravity_on_ramp(double angle) { return {9.81 * std::sin(angle), -9.81 * std::cos(angle)}; }

inline EventCount events(const Driver& driver, ContactEvent event) { return driver.statistics().of(event); }

}  // namespace plumb
