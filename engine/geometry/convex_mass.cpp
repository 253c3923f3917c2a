#include "engine/geometry/convex_mass.h"

#include <cmath>

#include "engine/math/arc_tangent.h"

namespace plumb {
namespace {

constexpr double kPi = 0x1.921fb54442d18p+1;

/// Moments of an area about the origin: of order 0, 1 and the polar one of order 2.
struct Moments {
  double area = 0;   // m^2
  Vec2d first{};     // m^3
  double polar = 0;  // m^4

  void operator+=(const Moments& b) { area += b.area, first += b.first, polar += b.polar; }
};

/// Returns the moments of a triangle with one corner at the origin: I = area (u.u + u.v + v.v) / 6.
Moments triangle(Vec2d u, Vec2d v) {
  const double area = cross(u, v) / 2;
  return {area, (area / 3) * (u + v), area * (dot(u, u) + dot(u, v) + dot(v, v)) / 6};
}

/// Returns the moments of the rectangle of width `radius` on the outside of the edge from u to v. About its
/// own centre I = area (length^2 + radius^2) / 12; then Steiner's theorem.
Moments rectangle(Vec2d u, Vec2d v, Vec2d normal, double radius) {
  const double length = std::sqrt(length_squared(v - u));
  const double area = length * radius;
  const Vec2d center = 0.5 * (u + v) + (radius / 2) * normal;
  return {area, area * center, area * ((length * length + radius * radius) / 12 + length_squared(center))};
}

/// Returns the moments of the circular sector about `center` between two unit normals. About its centre the
/// first moment is radius^3 / 3 times the integral of (cos, sin) over the angle, and the polar one radius^4
/// angle / 4.
Moments sector(Vec2d center, Vec2d from, Vec2d to, double radius) {
  const double angle = std::fabs(arc_tangent(cross(from, to), dot(from, to)));
  const double square = radius * radius;
  const double area = square * angle / 2;
  const Vec2d first = (square * radius / 3) * Vec2d{to.y - from.y, from.x - to.x};
  const double polar = square * square * angle / 4;
  return {area, area * center + first, area * length_squared(center) + 2 * dot(center, first) + polar};
}

/// Returns the moments of a shape about `origin`.
Moments moments(const Convex<double>& shape, Vec2d origin) {
  Moments sum;
  for (int i = 0; i < shape.count; ++i) {
    const int before = i > 0 ? i - 1 : shape.count - 1, after = i + 1 < shape.count ? i + 1 : 0;
    const Vec2d u = shape.corners[i].point - origin, v = shape.corners[after].point - origin;
    const Vec2d normal = shape.corners[i].normal;
    if (shape.count > 2) sum += triangle(u, v);
    if (shape.radius > 0) {
      sum += rectangle(u, v, normal, shape.radius);
      sum += sector(u, shape.corners[before].normal, normal, shape.radius);
    }
  }
  return sum;
}

}  // namespace

ConvexMass convex_mass(const Convex<double>& shape, double density) {
  if (shape.count == 1) {
    const double square = shape.radius * shape.radius, mass = density * (kPi * square);
    return {mass, shape.corners[0].point, mass * square / 2};
  }
  // Taken about the corners' mean, which is near the centroid, so that little cancels.
  Vec2d mean{};
  for (int i = 0; i < shape.count; ++i) mean += (1.0 / shape.count) * shape.corners[i].point;
  const Moments rough = moments(shape, mean);
  if (!(rough.area > 0)) return {0, mean, 0};
  const Vec2d centroid = mean + (1 / rough.area) * rough.first;
  const Moments about_centroid = moments(shape, centroid);
  return {density * about_centroid.area, centroid, density * about_centroid.polar};
}

}  // namespace plumb
