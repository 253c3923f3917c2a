#pragma once

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
  return placed(outline_in_body(world, shape),
                {.position = world.position(body), .angle = world.angle(body)});
}

}  // namespace plumb::harness::hunt
