#include "bench/field/mass.h"

#include <cmath>
#include <numbers>

namespace plumb::field {
namespace {

/// Integrals of density over an area, about the frame's origin.
struct Moments {
  double zeroth = 0;  ///< kg
  Vec2d first{};      ///< kg m
  double polar = 0;   ///< kg m^2

  void add(double mass, Vec2d centre, double inertia_about_centre) {
    zeroth += mass;
    first += mass * centre;
    polar += inertia_about_centre + mass * length_squared(centre);
  }
};

/// Adds a signed triangle: those between the origin and the edges of a polygon sum to the polygon.
void add_triangle(Moments& out, Vec2d a, Vec2d b) {
  const double area = cross(a, b) / 2;
  out.zeroth += area;
  out.first += (area / 3) * (a + b);
  out.polar += area / 6 * (dot(a, a) + dot(a, b) + dot(b, b));
}

/// Adds the sector of a disc between two unit normals. Theta is the angle between them, and the arms of its
/// moments lie along their bisector.
void add_sector(Moments& out, Vec2d corner, Vec2d n0, Vec2d n1, double radius) {
  const double theta = std::atan2(cross(n0, n1), dot(n0, n1));
  const double area = radius * radius * theta / 2;
  const Vec2d sum = n0 + n1;
  const Vec2d bisector = (1 / std::sqrt(length_squared(sum))) * sum;
  // The centroid of a sector lies 4 r sin(theta/2) / (3 theta) from its tip.
  const Vec2d arm = (2 * radius * radius * radius / 3 * std::sin(theta / 2)) * bisector;  // area x distance
  out.zeroth += area;
  out.first += area * corner + arm;
  out.polar += area * radius * radius / 2 + area * length_squared(corner) + 2 * dot(corner, arm);
}

Moments moments(const Circle& circle) {
  Moments out;
  const double square = circle.radius * circle.radius;
  out.add(std::numbers::pi * square, circle.centre, std::numbers::pi * square * square / 2);
  return out;
}

/// Sums the core, one rectangle per edge and one sector per corner (Steiner's formula).
Moments moments(const Polygon& polygon) {
  Moments out;
  const std::size_t n = polygon.points.size();
  std::vector<Vec2d> normals(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2d edge = polygon.points[(i + 1) % n] - polygon.points[i];
    normals[i] = (-1 / std::sqrt(length_squared(edge))) * perpendicular(edge);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2d a = polygon.points[i], b = polygon.points[(i + 1) % n];
    add_triangle(out, a, b);
    if (polygon.radius == 0) continue;
    const Vec2d shift = polygon.radius * normals[i];
    const double length = std::sqrt(length_squared(b - a)), area = length * polygon.radius;
    out.add(area, 0.5 * (a + b + shift), area / 12 * (length * length + polygon.radius * polygon.radius));
    add_sector(out, b, normals[i], normals[(i + 1) % n], polygon.radius);
  }
  return out;
}

/// Sums a rectangle and half a disc at either end.
Moments moments(const Capsule& capsule) {
  Moments out;
  const Vec2d axis = capsule.b - capsule.a;
  const double length = std::sqrt(length_squared(axis)), r = capsule.radius;
  if (length == 0) return moments(Circle{capsule.a, r});
  const double rectangle = 2 * r * length, disc = std::numbers::pi * r * r;
  // Half discs moved outwards by l/2: the disc's own inertia, Steiner's term, and twice the centroid's arm.
  const double caps =
      disc * (r * r / 2 + length * length / 4) + disc * length * (4 * r / (3 * std::numbers::pi));
  out.add(rectangle + disc, 0.5 * (capsule.a + capsule.b),
          rectangle / 12 * (length * length + 4 * r * r) + caps);
  return out;
}

Moments moments(const Segment&) { return {}; }

}  // namespace

MassProperties mass_of(std::span<const ShapeDefinition> shapes) {
  Moments sum;
  for (const ShapeDefinition& shape : shapes) {
    const Moments part = std::visit([](const auto& geometry) { return moments(geometry); }, shape.geometry);
    sum.zeroth += shape.density * part.zeroth;
    sum.first += shape.density * part.first;
    sum.polar += shape.density * part.polar;
  }
  if (sum.zeroth <= 0) return {};
  const Vec2d centre = (1 / sum.zeroth) * sum.first;
  return {sum.zeroth, centre, sum.polar - sum.zeroth * length_squared(centre)};
}

}  // namespace plumb::field
