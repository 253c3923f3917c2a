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
  Vec2d target;
  double tolerance;
  Vec2d point{};
  double violation = kInfinity, distance_squared = kInfinity;

  void consider(Vec2d candidate) {
    double worst = 0;
    for (const HalfPlane& plane : planes)
      worst = std::max(worst, plane.offset - dot(plane.normal, candidate));
    if (worst <= tolerance) worst = 0;
    const double squared = length_squared(candidate - target);
    if (worst < violation || (worst == violation && squared < distance_squared)) {
      point = candidate, violation = worst, distance_squared = squared;
    }
  }
};

}  // namespace

PlaneSolution solve_planes(std::span<const HalfPlane> planes, Vec2d target) {
  constexpr double kRounding = 1e-12;
  constexpr double kParallel = 1e-9;  // sine of the angle below which borders count as parallel
  double size = std::abs(target.x) + std::abs(target.y);
  for (const HalfPlane& plane : planes) size = std::max(size, std::abs(plane.offset));
  Best best{planes, target, kRounding * size};
  best.consider(target);
  if (best.violation == 0) return {target, true};
  for (const HalfPlane& plane : planes) {
    best.consider(target + (plane.offset - dot(plane.normal, target)) * plane.normal);
  }
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const Vec2d m = planes[i].normal, n = planes[j].normal;
      const double sine = cross(m, n);
      if (std::abs(sine) < kParallel) continue;
      const double a = planes[i].offset, b = planes[j].offset;
      best.consider({(a * n.y - b * m.y) / sine, (b * m.x - a * n.x) / sine});
    }
  }
  return {best.point, best.violation == 0};
}

}  // namespace plumb
