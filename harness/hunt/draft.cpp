#include <algorithm>
#include <cmath>

#include "engine/math/trigonometry.h"
#include "engine/scene/geometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {

Vec2d direction(double angle) {
  const Rotation<double> q = rotation_of(angle);
  return {q.c, q.s};
}

const std::string& Draft::name(int index) const {
  static const std::string world{kWorld};
  return index < 0 ? world : out.scene.bodies[static_cast<std::size_t>(index)].name;
}

int Draft::add(const Geometry& geometry, Vec2d at, double angle, BodyType type) {
  Body body;
  body.name = idiom + "." + std::to_string(out.scene.bodies.size());
  body.type = type;
  body.position = at;
  body.angle = angle;
  body.shapes = {{.geometry = geometry, .friction = friction, .restitution = restitution}};
  out.scene.bodies.push_back(std::move(body));
  weigh(count() - 1);
  return count() - 1;
}

void Draft::weigh(int index) {
  Body& made = body(index);
  double area = 0;
  Vec2d moment{};
  for (const Shape& shape : made.shapes) {
    const Extent extent = extent_of(shape.geometry);
    area += extent.area;
    moment += extent.area * (shape.position + rotation_of(shape.angle) * extent.centroid);
  }
  if (area <= 0) return;
  const Vec2d centre = (1 / area) * moment;
  made.position += rotation_of(made.angle) * centre;
  for (Shape& shape : made.shapes) shape.position -= centre;
  if (made.type == BodyType::Dynamic) made.mass = density * area;
}

int Draft::box(Vec2d at, double width, double height, double angle, BodyType type) {
  return add(Box{width, height}, at, angle, type);
}

int Draft::disc(Vec2d at, double radius, BodyType type) { return add(Circle{radius}, at, 0, type); }

Geometry Draft::any_geometry(double about) {
  const double r = about / 2;
  switch (random.whole(0, 6)) {
    case 0:
      return Circle{r};
    case 1:
      return Box{about, about * random.within(0.1, 1)};
    case 2:
      return Capsule{{-r * 0.7, 0}, {r * 0.7, 0}, r * random.within(0.1, 0.5)};
    case 3: {
      Polygon polygon;
      const int corners = random.whole(3, 8);
      for (int i = 0; i < corners; ++i)
        polygon.points.push_back(r * random.within(0.7, 1) * direction(6.2831853 * i / corners));
      if (random.chance(0.3)) polygon.radius = r * random.within(0.05, 0.3);
      return polygon;
    }
    case 4:
      return Polygon{{{-r, -r / 2}, {r, -r / 2}, {random.within(-0.9, 0.9) * r, r / 2}}};
    case 5:  // a needle, or nearly one
      return Box{about, about * random.ladder(1e-3, 0.1)};
    default:
      return Box{about, about};
  }
}

int Draft::any(Vec2d at, double about, double angle) { return add(any_geometry(about), at, angle); }

Vec2d Draft::local(int index, Vec2d point) const {
  if (index < 0) return point;
  const Body& of = out.scene.bodies[static_cast<std::size_t>(index)];
  return rotation_of(of.angle).inverse() * (point - of.position);
}

double Draft::relative_angle(int a, int b) const {
  const auto angle = [&](int index) {
    return index < 0 ? 0 : out.scene.bodies[static_cast<std::size_t>(index)].angle;
  };
  return angle(b) - angle(a);
}

RevoluteJoint& Draft::revolute(int a, int b, Vec2d at) {
  auto& joint = join<RevoluteJoint>(a, b);
  joint.anchor_a = local(a, at), joint.anchor_b = local(b, at);
  joint.reference_angle = relative_angle(a, b);
  return joint;
}

WeldJoint& Draft::weld(int a, int b, Vec2d at) {
  auto& joint = join<WeldJoint>(a, b);
  joint.anchor_a = local(a, at), joint.anchor_b = local(b, at);
  joint.reference_angle = relative_angle(a, b);
  return joint;
}

PrismaticJoint& Draft::prismatic(int a, int b, Vec2d at, Vec2d axis) {
  auto& joint = join<PrismaticJoint>(a, b);
  joint.anchor_a = local(a, at), joint.anchor_b = local(b, at);
  joint.axis = a < 0 ? axis : rotation_of(body(a).angle).inverse() * axis;
  joint.reference_angle = relative_angle(a, b);
  return joint;
}

WheelJoint& Draft::wheel(int a, int b, Vec2d at, Vec2d axis) {
  auto& joint = join<WheelJoint>(a, b);
  joint.anchor_a = local(a, at), joint.anchor_b = local(b, at);
  joint.axis = a < 0 ? axis : rotation_of(body(a).angle).inverse() * axis;
  return joint;
}

DistanceJoint& Draft::rod(int a, int b, Vec2d on_a, Vec2d on_b) {
  auto& joint = join<DistanceJoint>(a, b);
  joint.anchor_a = local(a, on_a), joint.anchor_b = local(b, on_b);
  const Vec2d way = on_b - on_a;
  joint.length = std::sqrt(dot(way, way));
  return joint;
}

void Draft::pass_each_other(int first) {
  for (int i = first; i < count(); ++i)
    for (Shape& shape : body(i).shapes) shape.filter.group = -1 - first;
}

void Draft::whirl(int first, Vec2d about, double rate) {
  for (int i = first; i < count(); ++i) {
    if (body(i).type != BodyType::Dynamic) continue;
    body(i).angular_velocity += rate;
    body(i).velocity += cross(rate, body(i).position - about);
  }
}

Expectation& Draft::expect(const std::string& name_of, int index, Quantity quantity) {
  out.expectations.push_back({.name = name_of, .body = name(index), .quantity = quantity});
  return out.expectations.back();
}

}  // namespace plumb::harness::hunt
