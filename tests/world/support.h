#pragma once

#include "engine/world/world.h"

/// Small scenes that several tests start from.
namespace plumb {

inline constexpr double kGravity = 9.81;

/// A static body with a wide box whose top is at y = 0.
template <class Real>
BodyId add_ground(BasicWorld<Real>& world, Material material = {}) {
  BodyDefinition body;
  body.name = "ground";
  body.type = BodyType::Static;
  return world.create_body(
      body, ShapeDefinition{.geometry = Box{200, 2}, .position = {0, -1}, .material = material});
}

template <class Real>
BodyId add_body(BasicWorld<Real>& world, Vec2d position, ShapeDefinition shape, Vec2d velocity = {}) {
  BodyDefinition body;
  body.position = position;
  body.velocity = velocity;
  return world.create_body(body, shape);
}

template <class Real>
BodyId add_box(BasicWorld<Real>& world, Vec2d position, double density = 1, double width = 1,
               double height = 1) {
  return add_body(world, position, {.geometry = Box{width, height}, .density = density});
}

template <class Real>
void run(BasicWorld<Real>& world, int steps, double dt = 1.0 / 60, int substeps = 4) {
  for (int i = 0; i < steps; ++i) world.step(dt, substeps);
}

inline WorldDefinition without_sleep() { return {.sleeping = false}; }
inline WorldDefinition weightless() { return {.gravity = {0, 0}}; }

}  // namespace plumb
