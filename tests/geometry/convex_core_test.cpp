#include "engine/geometry/convex_core.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace plumb {
namespace {

std::vector<Corner<double>> polygon(const std::vector<Vec2d>& points) {
  std::vector<Corner<double>> corners;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2d edge = points[(i + 1) % points.size()] - points[i];
    const double length = std::hypot(edge.x, edge.y);
    corners.push_back({points[i], {edge.y / length, -edge.x / length}});
  }
  return corners;
}

Convex<double> view(const std::vector<Corner<double>>& corners, double radius = 0) {
  return {corners.data(), static_cast<int>(corners.size()), radius};
}

// m, how deep a point lies below the nearest edge.
double depth_of(const std::vector<Corner<double>>& corners, Vec2d point) {
  double least = 1e300;
  for (const Corner<double>& corner : corners)
    least = std::min(least, dot(corner.normal, corner.point - point));
  return least;
}

TEST(Core, OfABoxIsASmallerBox) {
  const auto box = polygon({{-2, -1}, {2, -1}, {2, 1}, {-2, 1}});
  const Core<double> core(view(box), 0.25);
  ASSERT_EQ(core.convex().count, 4);
  EXPECT_NEAR(core.convex().corners[0].point.x, -1.75, 1e-12);
  EXPECT_NEAR(core.convex().corners[0].point.y, -0.75, 1e-12);
}

TEST(Core, TakesTheRoundingFirst) {
  const auto box = polygon({{-2, -1}, {2, -1}, {2, 1}, {-2, 1}});
  const Core<double> some(view(box, 0.5), 0.2), more(view(box, 0.5), 0.75);
  EXPECT_NEAR(some.convex().radius, 0.3, 1e-12);
  EXPECT_NEAR(some.convex().corners[2].point.y, 1, 1e-12);
  EXPECT_NEAR(more.convex().radius, 0, 1e-12);
  EXPECT_NEAR(more.convex().corners[2].point.y, 0.75, 1e-12);
}

// An edge shorter than what comes off vanishes: the core is what is left of the shape without that corner
// cut.
TEST(Core, LosesShortEdges) {
  const auto cut = polygon({{-1, -1}, {1, -1}, {1, 0.99}, {0.99, 1}, {-1, 1}});
  const Core<double> core(view(cut), 0.5);
  for (int i = 0; i < core.convex().count; ++i)
    EXPECT_NEAR(depth_of(cut, core.convex().corners[i].point), 0.5, 1e-9);
  double right = -1;
  for (int i = 0; i < core.convex().count; ++i) right = std::max(right, core.convex().corners[i].point.x);
  EXPECT_NEAR(right, 0.5, 1e-9);
}

TEST(Core, LiesEvenlyDeepInAnyPolygon) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> spread(-1, 1);
  for (int round = 0; round < 2000; ++round) {
    std::vector<Vec2d> points;
    for (int i = 0; i < 3 + round % 9; ++i) points.push_back({spread(random), 0.3 * spread(random)});
    // The hull, counter-clockwise.
    std::sort(points.begin(), points.end(),
              [](Vec2d a, Vec2d b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<Vec2d> hull;
    for (int side = 0; side < 2; ++side) {
      const std::size_t first = hull.size();
      for (const Vec2d p : points) {
        while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
          hull.pop_back();
        hull.push_back(p);
      }
      hull.pop_back();
      std::reverse(points.begin(), points.end());
    }
    if (hull.size() < 3) continue;
    const auto corners = polygon(hull);
    const double depth = convex_tunnelling_width(view(corners)) / 2;
    const Core<double> core(view(corners), depth);
    ASSERT_GT(core.convex().count, 0);
    // All of the core is that deep, and no corner of the shape is far from it.
    for (int i = 0; i < core.convex().count; ++i)
      EXPECT_NEAR(depth_of(corners, core.convex().corners[i].point), depth, 1e-9);
    const double most = 1.5 * convex_half_width(view(corners));
    for (const Vec2d p : hull) {
      double nearest = 1e300;
      for (int i = 0; i < core.convex().count; ++i) {
        const Vec2d d = core.convex().corners[i].point - p;
        nearest = std::min(nearest, std::hypot(d.x, d.y));
      }
      EXPECT_LE(nearest, most * (1 + 1e-9));
    }
  }
}

TEST(PassingWidth, IsHalfTheWidthOfWhatIsBlunt) {
  EXPECT_NEAR(convex_tunnelling_width(view(polygon({{-2, -1}, {2, -1}, {2, 1}, {-2, 1}}))), 1, 1e-12);
  const std::vector<Corner<double>> disc{{{0, 0}, {}}};
  EXPECT_NEAR(convex_tunnelling_width(view(disc, 0.5)), 0.5, 1e-12);
}

}  // namespace
}  // namespace plumb
