#include "bench/field/gap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::field {
namespace {

std::vector<Vec2d> core_of(const Circle& circle) { return {circle.centre}; }
std::vector<Vec2d> core_of(const Capsule& capsule) { return {capsule.a, capsule.b}; }
std::vector<Vec2d> core_of(const Polygon& polygon) { return polygon.points; }
std::vector<Vec2d> core_of(const Segment& segment) { return {segment.a, segment.b}; }

double radius_of(const Segment&) { return 0; }
template <class Round>
double radius_of(const Round& round) {
  return round.radius;
}

/// Returns the largest separation of b's core from a's along an edge normal of a; minus infinity without
/// edges.
double separation_along_normals(const std::vector<Vec2d>& a, const std::vector<Vec2d>& b) {
  double best = -std::numeric_limits<double>::infinity();
  if (a.size() < 2) return best;
  for (std::size_t i = 0; i < a.size(); ++i) {  // both sides of a segment
    const Vec2d edge = a[(i + 1) % a.size()] - a[i];
    const double size = length(edge);
    if (size == 0) continue;
    const Vec2d normal = (-1 / size) * perpendicular(edge);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2d p : b) nearest = std::min(nearest, dot(normal, p - a[i]));
    best = std::max(best, nearest);
  }
  return best;
}

double distance_to_segment(Vec2d p, Vec2d a, Vec2d b) {
  const Vec2d edge = b - a;
  const double square = length_squared(edge);
  const double t = square == 0 ? 0 : std::clamp(dot(p - a, edge) / square, 0.0, 1.0);
  return length(p - a - t * edge);
}

/// Returns the smallest distance of a corner of a from an edge of b.
double corners_to_edges(const std::vector<Vec2d>& a, const std::vector<Vec2d>& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec2d p : a)
    for (std::size_t i = 0; i < b.size(); ++i)
      least = std::min(least, distance_to_segment(p, b[i], b[(i + 1) % b.size()]));
  return least;
}

}  // namespace

PlacedShape place(const Geometry& geometry, const BodyState& state) {
  PlacedShape out;
  out.core = std::visit([](const auto& shape) { return core_of(shape); }, geometry);
  out.radius = std::visit([](const auto& shape) { return radius_of(shape); }, geometry);
  const Rotation<double> rotation{std::cos(state.angle), std::sin(state.angle)};
  for (Vec2d& point : out.core) point = state.position + rotation * point;
  return out;
}

double gap(const PlacedShape& a, const PlacedShape& b) {
  const double radii = a.radius + b.radius;
  const double separation =
      std::max(separation_along_normals(a.core, b.core), separation_along_normals(b.core, a.core));
  // The cores touch at most, or both are points: the shortest distance is that of a corner.
  if (separation >= 0 || (a.core.size() == 1 && b.core.size() == 1))
    return std::min(corners_to_edges(a.core, b.core), corners_to_edges(b.core, a.core)) - radii;
  return separation - radii;
}

}  // namespace plumb::field
