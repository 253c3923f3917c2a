#pragma once

#include <cmath>

#include "engine/world/world.h"
#include "harness/hunt/outline.h"

namespace plumb::harness::hunt {

/// Returns the outline of a shape, in the world or in its body's frame.
template <class Real>
Outline outline_in_body(const BasicWorld<Real>& world, ShapeId shape) {
  const ShapeDefinition definition = world.definition(shape);
  Shape out;
  out.position = definition.position, out.angle = definition.angle;
  std::visit([&](const auto& geometry) { out.geometry = geometry; }, definition.geometry);
  return outlines_of(out).front();
}
template <class Real>
Outline outline_in_world(const BasicWorld<Real>& world, ShapeId shape) {
  const BodyId body = world.body(shape);
  // The direction of the body's shapes gives the angle up to whole turns. It is only approximate if the body
  // rotates by many turns a step.
  const Vec2d at = world.position(body), along = world.world_point(body, {1, 0}) - at;
  return placed(outline_in_body(world, shape), {.position = at, .angle = std::atan2(along.y, along.x)});
}

}  // namespace plumb::harness::hunt
