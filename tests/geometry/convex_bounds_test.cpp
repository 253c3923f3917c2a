#include "engine/geometry/convex_bounds.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/geometry/rounded_corners.h"

namespace plumb {
namespace {

template <class Real>
struct Solid {
  std::vector<Corner<Real>> corners;
  Real radius = 0;
  Solid(const Corners& exact, double r) : corners(rounded_to<Real>(exact)), radius(static_cast<Real>(r)) {}
  Convex<Real> view() const { return {corners.data(), static_cast<int>(corners.size()), radius}; }
};

const std::vector<Vec2d> kPentagon = {{0, 0}, {1, -0.2}, {1.5, 0.6}, {0.7, 1.1}, {-0.1, 0.8}};

// A 2 x 1 box turned by 30 degrees reaches 1 cos + 0.5 sin along x and 1 sin + 0.5 cos along y.
TEST(ConvexBounds, Box) {
  const Solid<double> box(box_corners(1, 0.5), 0.125);
  const Aabb<double> bounds = convex_bounds(box.view(), {{3, 4}, {std::sqrt(3.0) / 2, 0.5}});
  const double x = std::sqrt(3.0) / 2 + 0.25 + 0.125, y = 0.5 + std::sqrt(3.0) / 4 + 0.125;
  EXPECT_NEAR(bounds.lower.x, 3 - x, 1e-15);
  EXPECT_NEAR(bounds.upper.x, 3 + x, 1e-15);
  EXPECT_NEAR(bounds.lower.y, 4 - y, 1e-15);
  EXPECT_NEAR(bounds.upper.y, 4 + y, 1e-15);
}

TEST(ConvexBounds, DiscAndCapsule) {
  const Solid<double> disc(disc_corner({1, 0}), 0.5);
  EXPECT_EQ(convex_bounds(disc.view(), {{10, 20}, {0, 1}}).lower, (Vec2d{9.5, 20.5}));
  EXPECT_EQ(convex_bounds(disc.view(), {{10, 20}, {0, 1}}).upper, (Vec2d{10.5, 21.5}));
  const Solid<double> capsule(capsule_corners({-2, 0}, {2, 1}), 0.5);
  EXPECT_EQ(convex_bounds(capsule.view(), {{0, 0}, {0, 1}}).lower, (Vec2d{-1.5, -2.5}));
  EXPECT_EQ(convex_bounds(capsule.view(), {{0, 0}, {0, 1}}).upper, (Vec2d{0.5, 2.5}));
}

// Every corner is inside, and each side is met by one.
TEST(ConvexBounds, AreTight) {
  std::mt19937_64 bits(3);
  const auto number = [&bits] { return static_cast<double>(bits() >> 11) * 0x1p-52 - 1; };
  for (const Corners& corners :
       {convex_hull(kPentagon), box_corners(1, 2, {3, 1}), capsule_corners({1, 2}, {5, 1}),
        convex_hull(std::vector<Vec2d>{{0, 0}, {1, 0}, {2, 2}, {0, 1}})}) {
    const Solid<float> shape(corners, 0.25);
    for (int trial = 0; trial < 100; ++trial) {
      const double angle = 4 * number();
      const Pose<float> pose{{static_cast<float>(10 * number()), static_cast<float>(10 * number())},
                             {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))}};
      const Aabb<float> box = convex_bounds(shape.view(), pose);
      double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY;
      for (const auto& corner : shape.corners) {
        const Vec2d p = pose.position.as<double>() +
                        Rotation<double>{pose.rotation.c, pose.rotation.s} * corner.point.as<double>();
        low_x = std::min(low_x, p.x - 0.25), high_x = std::max(high_x, p.x + 0.25);
        low_y = std::min(low_y, p.y - 0.25), high_y = std::max(high_y, p.y + 0.25);
      }
      EXPECT_NEAR(box.lower.x, low_x, 3e-6);
      EXPECT_NEAR(box.lower.y, low_y, 3e-6);
      EXPECT_NEAR(box.upper.x, high_x, 3e-6);
      EXPECT_NEAR(box.upper.y, high_y, 3e-6);
    }
  }
}

TEST(ConvexExtent, FarthestPoint) {
  EXPECT_EQ(convex_extent(Solid<double>(box_corners(3, 4), 0).view(), {0, 0}), 5);
  EXPECT_EQ(convex_extent(Solid<double>(box_corners(3, 4), 0.5).view(), {-3, -4}), 10.5);
  EXPECT_EQ(convex_extent(Solid<double>(disc_corner({3, 0}), 1).view(), {0, 4}), 6);
  EXPECT_EQ(convex_extent(Solid<float>(capsule_corners({-3, 0}, {6, 0}), 1).view(), {0, 0}), 7);
}

TEST(ConvexHalfWidth, ThinnestDirection) {
  EXPECT_EQ(convex_half_width(Solid<double>(box_corners(3, 0.5, {7, 7}), 0.25).view()), 0.75);
  EXPECT_EQ(convex_half_width(Solid<double>(disc_corner({3, 0}), 2).view()), 2);
  EXPECT_EQ(convex_half_width(Solid<double>(capsule_corners({0, 0}, {9, 9}), 0.5).view()), 0.5);
  EXPECT_EQ(convex_half_width(Solid<double>(capsule_corners({0, 0}, {9, 9}), 0).view()), 0);
  // An equilateral triangle of side 1 is sqrt(3)/2 high.
  const Solid<double> triangle(convex_hull(std::vector<Vec2d>{{0, 0}, {1, 0}, {0.5, std::sqrt(0.75)}}), 0);
  EXPECT_NEAR(convex_half_width(triangle.view()), std::sqrt(0.75) / 2, 1e-15);
}

}  // namespace
}  // namespace plumb
