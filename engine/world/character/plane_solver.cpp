#include "engine/world/character/plane_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The best point so far: the nearest one inside all half planes or, if there is none, the one least outside.
struct Best {
  std::span<const HalfPlane> planes;
  Vec2d wanted;
  double tolerance;
  Vec2d point{};
  double outside = kInfinity, square = kInfinity;

  void consider(Vec2d candidate) {
    double worst = 0;
    for (const HalfPlane& plane : planes) worst = std::max(worst, plane.least - dot(plane.normal, candidate));
    if (worst <= tolerance) worst = 0;
    const double here = length_squared(candidate - wanted);
    if (worst < outside || (worst == outside && here < square)) {
      point = candidate, outside = worst, square = here;
    }
  }
};

}  // namespace

PlaneSolution solve_planes(std::span<const HalfPlane> planes, Vec2d wanted) {
  constexpr double kRounding = 1e-12;
  constexpr double kParallel = 1e-9;  // sine of the angle below which borders count as parallel
  double size = std::abs(wanted.x) + std::abs(wanted.y);
  for (const HalfPlane& plane : planes) size = std::max(size, std::abs(plane.least));
  Best best{planes, wanted, kRounding * size};
  best.consider(wanted);
  if (best.outside == 0) return {wanted, true};
  for (const HalfPlane& plane : planes) {
    best.consider(wanted + (plane.least - dot(plane.normal, wanted)) * plane.normal);
  }
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const Vec2d m = planes[i].normal, n = planes[j].normal;
      const double sine = cross(m, n);
      if (std::abs(sine) < kParallel) continue;
      const double a = planes[i].least, b = planes[j].least;
      best.consider({(a * n.y - b * m.y) / sine, (b * m.x - a * n.x) / sine});
    }
  }
  return {best.point, best.outside == 0};
}

}  // namespace plumb
