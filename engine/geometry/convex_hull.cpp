#include "engine/geometry/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb {
namespace {

// Roundings of a coordinate by which a corner has to stand out. One rounding moves a corner by half of it,
// and thereby the edge beside it; a point that a program has turned and moved onto an edge lies up to four
// off it. With fewer than three, an outline could be dented after it was rounded.
constexpr double kRoundings = 8;

// Thickness, as a fraction of the extent, up to which points count as lying on a line: a hundred roundings of
// a float, so that a polygon has a mass and an inside in either precision.
constexpr double kFlat = 1e-5;

// Above this number of corners, details below the rounding are not dropped, because the search for them is
// quadratic: the points are refused.
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

double distance_to_segment(Vec2d point, Vec2d start, Vec2d end) {
  const Vec2d edge = end - start, offset = point - start;
  const double size = length_squared(edge), along = dot(offset, edge);
  if (!(along > 0)) return std::sqrt(length_squared(offset));
  if (along >= size) return std::sqrt(length_squared(point - end));
  return std::fabs(cross(edge, offset)) / std::sqrt(size);
}

/// Drops corners of a hull, those that stand out least first, as long as no corner that was dropped is
/// farther than `most` from the outline that remains. Three corners always remain.
void drop_details(std::vector<Vec2d>& hull, double most) {
  const std::size_t all = hull.size();
  std::vector<std::size_t> kept(all);
  for (std::size_t i = 0; i < all; ++i) kept[i] = i;
  // Returns how far the outline would be from a corner, if kept[i] and all dropped beside it were cut off.
  const auto detail_at = [&](std::size_t i) {
    const std::size_t before = kept[(i + kept.size() - 1) % kept.size()], after = kept[(i + 1) % kept.size()];
    double farthest = 0;
    for (std::size_t k = (before + 1) % all; k != after; k = (k + 1) % all)
      farthest = std::max(farthest, distance_to_segment(hull[k], hull[before], hull[after]));
    return farthest;
  };
  std::vector<double> details(all);
  for (std::size_t i = 0; i < all; ++i) details[i] = detail_at(i);
  while (kept.size() > 3) {
    const auto least = std::min_element(details.begin(), details.end());
    if (*least > most) break;
    const auto i = least - details.begin();
    kept.erase(kept.begin() + i), details.erase(least);
    const std::size_t after = static_cast<std::size_t>(i) % kept.size(),
                      before = (after + kept.size() - 1) % kept.size();
    details[before] = detail_at(before), details[after] = detail_at(after);
  }
  for (std::size_t i = 0; i < kept.size(); ++i) hull[i] = hull[kept[i]];
  hull.resize(kept.size());
}

/// Returns the least width of a convex polygon, m, which is across one of its edges.
double thickness(const std::vector<Vec2d>& hull) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2d start = hull[i], edge = hull[(i + 1) % hull.size()] - start;
    double height = 0;
    for (const Vec2d point : hull) height = std::max(height, cross(edge, point - start));
    least = std::min(least, height / std::sqrt(length_squared(edge)));
  }
  return least;
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

double outline_rounding(std::span<const Vec2d> points, double spacing, Vec2d position) {
  double farthest = 0;
  for (const Vec2d point : points) farthest = std::max(farthest, length_squared(point));
  return kRoundings * spacing * (std::sqrt(farthest) + std::sqrt(length_squared(position)));
}

Corners convex_hull(std::span<const Vec2d> points, double detail) {
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
  if (hull.size() < 3) refuse_flat();
  drop_details(hull, std::max(detail, outline_rounding(hull, std::numeric_limits<double>::epsilon())));
  if (!(thickness(hull) > kFlat * std::max(upper.x - lower.x, upper.y - lower.y))) refuse_flat();
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
