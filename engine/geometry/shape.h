#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/aabb.h"
#include "engine/joints/row.h"
#include "engine/math/vec2.h"
#include "engine/scene/scene.h"

namespace plumb {

enum class ShapeKind : std::uint8_t { Circle, Box };

/// A shape for collision, in its body's frame.
template <class Real>
struct SolidShape {
  ShapeKind kind = ShapeKind::Circle;
  int body = 0;
  Vec2<Real> center{};        ///< m, in the body's frame
  Rotation<Real> rotation{};  ///< in the body's frame
  Vec2<Real> half{};          ///< m, a box's half width and half height
  Real radius = 0;            ///< m, a circle's
  Real reach = 0;             ///< m, from the shape's centre to its farthest point
};

/// Pose of a shape in the world.
template <class Real>
struct Placement {
  Vec2<Real> center{};
  Rotation<Real> rotation{};
};

template <class Real>
Placement<Real> place(const SolidShape<Real>& shape, const Pose<Real>& body) {
  const Rotation<Real> q = body.rotation, r = shape.rotation;
  return {body.position + q * shape.center, {q.c * r.c - q.s * r.s, q.s * r.c + q.c * r.s}};
}

/// Returns the axis-aligned bounding box of `shape`.
template <class Real>
Aabb<Real> bounds_of(const SolidShape<Real>& shape, const Placement<Real>& at);

/// Returns the shapes of a scene, body by body in the scene's order.
template <class Real>
std::vector<SolidShape<Real>> compile_shapes(const Scene& scene);

}  // namespace plumb
