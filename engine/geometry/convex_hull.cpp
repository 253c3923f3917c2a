#include "engine/geometry/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb {
namespace {

// Fraction of the extent below which a detail of the outline is dropped: a hundred roundings of a float, so
// that edges have a direction in either precision.
constexpr double kDetail = 1e-5;

// Above this number of corners, small details are not dropped, because the search for them is quadratic: the
// points are refused.
constexpr std::size_t kMostExactCorners = 2048;

// m. Beyond it, squares of lengths leave a double's range.
constexpr double kLargestCoordinate = 1e100;

[[noreturn]] void refuse(const std::string& value, const std::string& problem) {
  throw Error(Error::Kind::Value, "shape", "points", value, problem);
}

[[noreturn]] void refuse_count(std::size_t count) {
  refuse(std::to_string(count) + " corners",
         "A convex shape has at most " + std::to_string(kMaxCorners) +
             " corners. Leave out points, or build the outline from several shapes.");
}

double orientation(Vec2d a, Vec2d b, Vec2d c) { return cross(b - a, c - b); }

/// Computes the hull by Andrew's monotone chain (1979) over points in lexicographic order; points on an edge
/// are left out.
std::vector<Vec2d> hull_of_sorted(const std::vector<Vec2d>& points) {
  std::vector<Vec2d> hull;
  const auto walk = [&hull](auto begin, auto end) {
    const std::size_t start = hull.size();
    for (auto point = begin; point != end; ++point) {
      while (hull.size() >= start + 2 && orientation(hull[hull.size() - 2], hull.back(), *point) <= 0)
        hull.pop_back();
      hull.push_back(*point);
    }
    hull.pop_back();  // the second pass begins with this point
  };
  walk(points.begin(), points.end());
  walk(points.rbegin(), points.rend());
  return hull;
}

/// Returns the distance of the corner from the line through its neighbours, or from the nearer neighbour if
/// that is less.
double detail_at(const std::vector<Vec2d>& hull, std::size_t i) {
  const Vec2d before = hull[(i + hull.size() - 1) % hull.size()], at = hull[i];
  const Vec2d after = hull[(i + 1) % hull.size()];
  const double to_neighbour = std::sqrt(std::min(length_squared(at - before), length_squared(after - at)));
  const double base = std::sqrt(length_squared(after - before));
  return base > 0 ? std::min(to_neighbour, std::fabs(orientation(before, at, after)) / base) : 0;
}

/// Drops the corner with the least detail until none is at most `size`.
void drop_details(std::vector<Vec2d>& hull, double size) {
  while (hull.size() > 2) {
    std::size_t least = 0;
    double least_detail = detail_at(hull, 0);
    for (std::size_t i = 1; i < hull.size(); ++i)
      if (const double detail = detail_at(hull, i); detail < least_detail) least = i, least_detail = detail;
    if (least_detail > size) return;
    hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

/// Sets the unit normals of the edges, outward: to the right of a counter-clockwise outline.
void set_normals(Corners& corners) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2d edge = corners[(i + 1) % corners.size()].point - corners[i].point;
    const double length = std::sqrt(length_squared(edge));
    corners[i].normal = {edge.y / length, -edge.x / length};
  }
}

}  // namespace

Corners convex_hull(std::span<const Vec2d> points) {
  for (const Vec2d point : points)
    if (!(std::fabs(point.x) <= kLargestCoordinate && std::fabs(point.y) <= kLargestCoordinate))
      refuse("(" + shortest(point.x) + ", " + shortest(point.y) + ")",
             "Points must be finite, and below 1e100 m.");
  std::vector<Vec2d> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(),
            [](Vec2d a, Vec2d b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const auto refuse_flat = [&points] {
    refuse(std::to_string(points.size()) + " points",
           "A polygon needs three points that are not in a line. Use a circle, a capsule or a segment.");
  };
  if (sorted.size() < 3) refuse_flat();

  Vec2d lower = sorted.front(), upper = lower;
  for (const Vec2d point : sorted) {
    lower = {std::min(lower.x, point.x), std::min(lower.y, point.y)};
    upper = {std::max(upper.x, point.x), std::max(upper.y, point.y)};
  }
  std::vector<Vec2d> hull = hull_of_sorted(sorted);
  if (hull.size() > kMostExactCorners) refuse_count(hull.size());
  drop_details(hull, kDetail * std::max(upper.x - lower.x, upper.y - lower.y));
  if (hull.size() < 3) refuse_flat();
  if (hull.size() > static_cast<std::size_t>(kMaxCorners)) refuse_count(hull.size());

  Corners corners;
  for (const Vec2d point : hull) corners.push_back({point, {}});
  set_normals(corners);
  return corners;
}

Corners box_corners(double half_width, double half_height, Vec2d center, Rotation<double> rotation) {
  const Vec2d x{rotation.c, rotation.s}, y = perpendicular(x);
  const Vec2d right = half_width * x, up = half_height * y;
  return {{center - right - up, -y},
          {center + right - up, x},
          {center + right + up, y},
          {center - right + up, -x}};
}

Corners capsule_corners(Vec2d first, Vec2d second) {
  const Vec2d axis = second - first;
  const double length = std::sqrt(length_squared(axis));
  if (!(length > 0)) return disc_corner(first);
  const Vec2d normal{axis.y / length, -axis.x / length};
  return {{first, normal}, {second, -normal}};
}

Corners disc_corner(Vec2d center) { return {{center, {}}}; }

Corners transformed(std::span<const Corner<double>> corners, const Pose<double>& pose) {
  Corners out;
  for (const Corner<double>& corner : corners)
    out.push_back({pose.position + pose.rotation * corner.point, pose.rotation * corner.normal});
  return out;
}

Corners translated(std::span<const Corner<double>> corners, Vec2d by) {
  Corners out(corners.begin(), corners.end());
  for (Corner<double>& corner : out) corner.point += by;
  return out;
}

}  // namespace plumb
