#pragma once

#include <algorithm>

#include "engine/world/world_data.h"

/// Returns shapes and chains as definitions, from which they could be created again: the arguments of
/// `create_shape` and `create_chain`, in the body's frame and rounded to Real.
namespace plumb {

template <class Real>
Vec2d corner_of(const WorldData<Real>& w, int shape, int corner) {
  const Vec2<Real> local = w.convex(shape).corners[corner].point;
  return local.template as<double>() + w.bodies[w.shapes[shape].body].centre.template as<double>();
}

template <class Real>
Material material_of(const ShapeRecord<Real>& record) {
  return {record.friction, record.restitution, record.rolling_resistance, record.surface_speed};
}

/// A circle's position is its centre; other shapes have corners in the body's frame. Boxes become polygons.
template <class Real>
ShapeDefinition shape_definition(const WorldData<Real>& w, int shape) {
  const ShapeForm<Real>& form = w.forms[shape];
  const ShapeRecord<Real>& record = w.shapes[shape];
  const double radius = static_cast<double>(form.radius);
  ShapeDefinition out{.density = static_cast<double>(record.density),
                      .material = material_of(record),
                      .filter = record.filter,
                      .sensor = form.sensor,
                      .hit_events = record.hit_events,
                      .pre_solve = record.pre_solve,
                      .user_data = w.shape_data.get(shape)};
  if (form.count == 1) {
    out.geometry = Circle{radius};
    out.position = corner_of(w, shape, 0);
  } else if (form.count == 2) {
    const Vec2d start = corner_of(w, shape, 0), end = corner_of(w, shape, 1);
    if (radius > 0) {
      out.geometry = Capsule{start, end, radius};
    } else {
      out.geometry = Segment{start, end};
    }
  } else {
    Polygon polygon{.radius = radius};
    for (int i = 0; i < form.count; ++i) polygon.points.push_back(corner_of(w, shape, i));
    out.geometry = std::move(polygon);
  }
  return out;
}

/// Filter, user data and flags are those of the first segment. Segments that differ in material give
/// `materials`.
template <class Real>
ChainDefinition chain_definition(const WorldData<Real>& w, int chain) {
  const std::vector<int>& segments = w.chains[chain].shapes;
  const int first = segments.front();
  ChainDefinition out{.material = material_of(w.shapes[first]),
                      .filter = w.shapes[first].filter,
                      .sensor = w.forms[first].sensor,
                      .hit_events = w.shapes[first].hit_events,
                      .pre_solve = w.shapes[first].pre_solve,
                      .user_data = w.shape_data.get(first)};
  for (const int segment : segments) out.points.push_back(corner_of(w, segment, 0));
  const auto differs = [&](int segment) { return material_of(w.shapes[segment]) != out.material; };
  if (std::any_of(segments.begin(), segments.end(), differs)) {
    for (const int segment : segments) out.materials.push_back(material_of(w.shapes[segment]));
  }
  // An open end is its own neighbour (see `add_chain`).
  const Vec2<Real> before = w.corners.data()[w.forms[first].corner].point;
  const Vec2<Real> start = w.convex(first).corners[0].point;
  out.closed = before.x != start.x || before.y != start.y;
  if (!out.closed) out.points.push_back(corner_of(w, segments.back(), 1));
  return out;
}

}  // namespace plumb
