#include "engine/geometry/shape.h"

#include <cmath>

#include "engine/math/trigonometry.h"

namespace plumb {

template <class Real>
Aabb<Real> bounds_of(const SolidShape<Real>& shape, const Placement<Real>& at) {
  Vec2<Real> extent{shape.radius, shape.radius};
  if (shape.kind == ShapeKind::Box) {
    const Real c = std::abs(at.rotation.c), s = std::abs(at.rotation.s);
    extent = {c * shape.half.x + s * shape.half.y, s * shape.half.x + c * shape.half.y};
  }
  return {at.center - extent, at.center + extent};
}

namespace {

template <class Real>
SolidShape<Real> compile_shape(const Shape& shape, int body) {
  SolidShape<Real> out;
  out.body = body;
  out.center = shape.position.as<Real>();
  const Rotation<double> rotation = rotation_of(shape.angle);
  out.rotation = {static_cast<Real>(rotation.c), static_cast<Real>(rotation.s)};
  if (const auto* circle = std::get_if<Circle>(&shape.geometry)) {
    out.kind = ShapeKind::Circle;
    out.radius = static_cast<Real>(circle->radius);
    out.reach = out.radius;
  } else {
    const Box& box = std::get<Box>(shape.geometry);
    out.kind = ShapeKind::Box;
    out.half = Vec2d{box.width / 2, box.height / 2}.as<Real>();
    out.reach = std::sqrt(length_squared(out.half));
  }
  return out;
}

}  // namespace

template <class Real>
std::vector<SolidShape<Real>> compile_shapes(const Scene& scene) {
  std::vector<SolidShape<Real>> out;
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    for (const Shape& shape : scene.bodies[body].shapes)
      out.push_back(compile_shape<Real>(shape, static_cast<int>(body)));
  return out;
}

template Aabb<float> bounds_of(const SolidShape<float>&, const Placement<float>&);
template Aabb<double> bounds_of(const SolidShape<double>&, const Placement<double>&);
template std::vector<SolidShape<float>> compile_shapes(const Scene&);
template std::vector<SolidShape<double>> compile_shapes(const Scene&);

}  // namespace plumb
