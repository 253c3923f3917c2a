#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/scene/validate.h"
#include "reference/backend.h"

/// Small scenes, and ways to run them, that the tests of the adapters share.
namespace plumb::reference::testing {

inline Body disc(std::string name, Vec2d position, double radius = 0.5, double mass = 1) {
  Body out;
  out.name = std::move(name);
  out.position = position;
  out.mass = mass;
  out.shapes = {{.geometry = Circle{radius}}};
  return out;
}

inline Body box(std::string name, Vec2d position, double width, double height, double mass = 1) {
  Body out = disc(std::move(name), position);
  out.mass = mass;
  out.shapes = {{.geometry = Box{width, height}}};
  return out;
}

inline Body of_type(Body body, BodyType type) {
  body.type = type;
  return body;
}

inline Body moving(Body body, Vec2d velocity, double angular_velocity = 0) {
  body.velocity = velocity;
  body.angular_velocity = angular_velocity;
  return body;
}

/// A scene without gravity.
inline Scene weightless(std::vector<Body> bodies) {
  Scene out;
  out.name = "test";
  out.gravity = {};
  out.bodies = std::move(bodies);
  return out;
}

/// The same under 9.81 m/s^2.
inline Scene falling(std::vector<Body> bodies) {
  Scene out = weightless(std::move(bodies));
  out.gravity = {0, -9.81};
  return out;
}

/// A disc on a hinge that lies at the origin, out to the right of it.
inline Scene pendulum() {
  Scene out = falling({disc("bob", {1, 0})});
  out.joints = {RevoluteJoint{.name = "hinge", .body_a = "world", .body_b = "bob", .anchor_b = {-1, 0}}};
  return out;
}

/// Two discs of 1 kg on the x axis, 1 m apart, that approach each other at 1 m/s; `a` has 0.2, `b` 0.8 of
/// restitution.
inline Scene head_on() {
  Scene out = weightless({moving(disc("a", {-1, 0}), {1, 0}), disc("b", {1, 0})});
  out.bodies[0].shapes[0].restitution = 0.2;
  out.bodies[1].shapes[0].restitution = 0.8;
  for (Body& body : out.bodies) body.shapes[0].friction = 0;
  return out;
}

/// The states after `duration`, or a multiple of dt nearest to it.
inline std::vector<BodyState> run(const Backend& engine, const Scene& scene, double duration,
                                  const StepSettings& settings) {
  validate(scene);
  const auto simulator = engine.create(scene, settings);
  simulator->advance(static_cast<int>(std::lround(duration / settings.dt)));
  std::vector<BodyState> out(scene.bodies.size());
  simulator->read(out);
  return out;
}

inline StepSettings steps_of(double dt, int substeps = 1) { return {.dt = dt, .substeps = substeps}; }

/// Unit roundoff of the engine's state.
inline double epsilon_of(const Backend& engine) { return engine.method(StepSettings{}).epsilon; }

}  // namespace plumb::reference::testing
