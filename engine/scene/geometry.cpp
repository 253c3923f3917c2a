#include "engine/scene/geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb {
namespace {

constexpr double kPi = std::numbers::pi;

/// Sums parts about the origin, and returns the whole about its centroid.
class ExtentSum {
 public:
  void add(const Extent& part) {
    area_ += part.area;
    first_ += part.area * part.centroid;
    second_ += part.area * (part.gyration_squared + length_squared(part.centroid));
  }
  Extent total() const {
    const Vec2d centroid = (1 / area_) * first_;
    return {area_, centroid, second_ / area_ - length_squared(centroid)};
  }

 private:
  double area_ = 0, second_ = 0;
  Vec2d first_{};
};

Extent of_rectangle(Vec2d centre, double width, double height) {
  return {width * height, centre, (width * width + height * height) / 12};
}

/// Computes a sector of angle 2 `half` about `tip`, opening along the unit vector `axis`. Its area is r^2
/// half, its centroid (2 r/3) sin(half)/half along the axis, and I/m is r^2/2 about the tip.
Extent of_sector(Vec2d tip, Vec2d axis, double half, double radius) {
  const double distance = 2 * radius / 3 * std::sin(half) / half;
  return {radius * radius * half, tip + distance * axis, radius * radius / 2 - distance * distance};
}

/// The squared radius of gyration about the centroid is (|u|^2 + |v|^2 - u.v) / 18, with u and v two sides
/// from one corner, the origin.
Extent of_triangle(Vec2d u, Vec2d v) {
  return {cross(u, v) / 2, (1.0 / 3) * (u + v), (length_squared(u) + length_squared(v) - dot(u, v)) / 18};
}

Extent extent(const Circle& circle) {
  return {kPi * circle.radius * circle.radius, {}, circle.radius * circle.radius / 2};
}

Extent extent(const Box& box) {
  return {box.width * box.height, {}, (box.width * box.width + box.height * box.height) / 12};
}

/// Returns the extent of a rounded polygon: corners counter-clockwise, the first at the origin, of a size
/// near 1.
Extent of_rounded(const std::vector<Vec2d>& corners, double radius) {
  ExtentSum sum;
  const std::size_t n = corners.size();
  for (std::size_t i = 1; i + 1 < n; ++i) sum.add(of_triangle(corners[i], corners[i + 1]));
  for (std::size_t i = 0; i < n && radius > 0; ++i) {
    const Vec2d before = corners[(i + n - 1) % n], here = corners[i], after = corners[(i + 1) % n];
    const double edge = length(after - here);
    const Vec2d along = (1 / edge) * (after - here), incoming = (1 / length(here - before)) * (here - before);
    sum.add(of_rectangle(0.5 * (here + after) - (radius / 2) * perpendicular(along), edge, radius));
    const double half = std::atan2(cross(incoming, along), dot(incoming, along)) / 2;
    const Vec2d axis = std::sin(half) * incoming - std::cos(half) * perpendicular(incoming);
    sum.add(of_sector(here, axis, half, radius));
  }
  return sum.total();
}

Extent extent(const Capsule& capsule) {
  const double r = capsule.radius, span = length(capsule.end - capsule.start);
  const Vec2d middle = 0.5 * (capsule.start + capsule.end);
  // A rectangle between two half discs: the centroid of a half disc lies 4 r/(3 pi) from its flat side.
  const double disc = kPi * r * r, between = 2 * r * span, area = disc + between;
  const double of_ends = r * r / 2 + span * span / 4 + span * (4 * r / (3 * kPi));
  const double of_middle = (span * span + 4 * r * r) / 12;
  return {area, middle, disc / area * of_ends + between / area * of_middle};
}

Extent extent(const Polygon& polygon) {
  std::vector<Vec2d> corners = convex_corners(polygon.points);
  if (corners.size() < 3) return {};
  const Vec2d origin = corners.front();
  double size = 0;
  for (Vec2d& corner : corners) corner -= origin, size = std::max(size, length(corner));
  for (Vec2d& corner : corners) corner = {corner.x / size, corner.y / size};
  const Extent unit = of_rounded(corners, polygon.radius / size);
  return {unit.area * size * size, origin + size * unit.centroid, unit.gyration_squared * size * size};
}

Extent extent(const Segment&) { return {}; }
Extent extent(const Chain&) { return {}; }

double max_length(const std::vector<Vec2d>& points) {
  double largest = 0;
  for (const Vec2d point : points) largest = std::max(largest, length(point));
  return largest;
}

double reach(const Circle& circle) { return circle.radius; }
double reach(const Box& box) { return std::sqrt(box.width * box.width + box.height * box.height) / 2; }
double reach(const Capsule& capsule) { return max_length({capsule.start, capsule.end}) + capsule.radius; }
double reach(const Polygon& polygon) { return max_length(polygon.points) + polygon.radius; }
double reach(const Segment& segment) { return max_length({segment.start, segment.end}); }
double reach(const Chain& chain) { return max_length(chain.points); }

}  // namespace

Extent extent_of(const Geometry& geometry) {
  return std::visit([](const auto& g) { return extent(g); }, geometry);
}

double reach_of(const Geometry& geometry) {
  return std::visit([](const auto& g) { return reach(g); }, geometry);
}

// Computes the hull by Andrew's monotone chain (1979).
std::vector<Vec2d> convex_corners(std::vector<Vec2d> points) {
  std::sort(points.begin(), points.end(),
            [](Vec2d a, Vec2d b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2d> hull;
  const auto add = [&](Vec2d point, std::size_t fixed) {
    while (hull.size() >= fixed + 2 &&
           cross(hull.back() - hull[hull.size() - 2], point - hull[hull.size() - 2]) <= 0)
      hull.pop_back();
    hull.push_back(point);
  };
  for (const Vec2d point : points) add(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();
  return hull;
}

}  // namespace plumb
