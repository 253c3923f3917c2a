#include "engine/realtime/manifold.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

SolidShape<double> circle(double radius) {
  SolidShape<double> out;
  out.radius = out.reach = radius;
  return out;
}

SolidShape<double> box(double width, double height) {
  SolidShape<double> out;
  out.kind = ShapeKind::Box;
  out.half = {width / 2, height / 2};
  out.reach = std::sqrt(length_squared(out.half));
  return out;
}

Placement<double> at(double x, double y, double angle = 0) { return {{x, y}, rotation_of(angle)}; }

void expect_near(Vec2d a, Vec2d b, double tolerance = 1e-14) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
}

TEST(Circles, SeparationAlongTheLineOfCentres) {
  const auto m = collide_circles(circle(1), at(0, 0), circle(0.5), at(3, 4));
  ASSERT_EQ(m.count, 1);
  expect_near(m.normal, {0.6, 0.8});
  EXPECT_NEAR(m.points[0].separation, 3.5, 1e-15);
  expect_near(m.points[0].on_a, {0.6, 0.8});
  expect_near(m.points[0].on_b, {2.7, 3.6});
}

TEST(Circles, EqualCentresGiveSomeNormal) {
  const auto m = collide_circles(circle(1), at(2, 2), circle(1), at(2, 2));
  EXPECT_EQ(length_squared(m.normal), 1);
  EXPECT_EQ(m.points[0].separation, -2);
}

TEST(BoxCircle, FaceCornerAndInside) {
  const auto face = collide(box(2, 1), at(0, 0), circle(0.5), at(0.3, 1.25), kAnywhere);
  EXPECT_EQ(face.normal, (Vec2d{0, 1}));
  EXPECT_EQ(face.points[0].separation, 0.25);
  expect_near(face.points[0].on_a, {0.3, 0.5});

  const auto corner = collide(box(2, 1), at(0, 0), circle(0.5), at(1.3, 0.9), kAnywhere);
  expect_near(corner.normal, {0.6, 0.8});
  EXPECT_NEAR(corner.points[0].separation, 0, 1e-15);

  const auto inside = collide(box(2, 1), at(0, 0), circle(0.1), at(0.9, 0.1), kAnywhere);
  EXPECT_EQ(inside.normal, (Vec2d{1, 0}));
  EXPECT_NEAR(inside.points[0].separation, -0.2, 1e-15);
}

TEST(BoxCircle, OrderOfShapesMirrorsTheManifold) {
  const auto box_first = collide(box(2, 1), at(0, 0, 0.4), circle(0.5), at(1.3, 0.9), kAnywhere);
  const auto circle_first = collide(circle(0.5), at(1.3, 0.9), box(2, 1), at(0, 0, 0.4), kAnywhere);
  EXPECT_EQ(circle_first.normal, -box_first.normal);
  EXPECT_EQ(circle_first.points[0].on_a, box_first.points[0].on_b);
  EXPECT_EQ(circle_first.points[0].separation, box_first.points[0].separation);
}

TEST(Boxes, StackedBoxesTouchAtTwoPoints) {
  const auto m = collide_boxes(box(4, 1), at(0, 0), box(1, 1), at(0.5, 1), 0.1);
  ASSERT_EQ(m.count, 2);
  EXPECT_EQ(m.normal, (Vec2d{0, 1}));
  EXPECT_NEAR(std::fmin(m.points[0].on_a.x, m.points[1].on_a.x), 0, 1e-15);
  EXPECT_NEAR(std::fmax(m.points[0].on_a.x, m.points[1].on_a.x), 1, 1e-15);
  for (const auto& point : m.points) EXPECT_EQ(point.separation, 0);
  EXPECT_NE(m.points[0].feature, m.points[1].feature);
}

TEST(Boxes, OverhangIsClippedToTheFace) {
  const auto m = collide_boxes(box(2, 1), at(0, 0), box(2, 1), at(1.5, 1), 0.1);
  ASSERT_EQ(m.count, 2);
  EXPECT_NEAR(std::fmin(m.points[0].on_a.x, m.points[1].on_a.x), 0.5, 1e-15);
  EXPECT_NEAR(std::fmax(m.points[0].on_a.x, m.points[1].on_a.x), 1, 1e-15);
}

// A unit square on its corner above a plate: the corner is sqrt(1/2) below its centre.
TEST(Boxes, CornerOnFace) {
  const double degrees45 = 0.78539816339744831;
  const auto m =
      collide_boxes(box(4, 1), at(0, 0), box(1, 1), at(0.2, 0.5 + std::sqrt(0.5) - 0.01, degrees45), 0.1);
  ASSERT_EQ(m.count, 1);
  expect_near(m.normal, {0, 1});
  EXPECT_NEAR(m.points[0].separation, -0.01, 1e-15);
  expect_near(m.points[0].on_b, {0.2, 0.49});
}

TEST(Boxes, NearlyParallelFacesKeepTheirFeatures) {
  const auto level = collide_boxes(box(1, 1), at(0, 0), box(1, 1), at(0.01, 1), 0.1);
  for (const double tilt : {-1e-4, 1e-6, 1e-4}) {
    const auto tilted = collide_boxes(box(1, 1), at(0, 0), box(1, 1), at(0.01, 1, tilt), 0.1);
    ASSERT_EQ(tilted.count, 2);
    EXPECT_EQ(tilted.points[0].feature, level.points[0].feature);
    EXPECT_EQ(tilted.points[1].feature, level.points[1].feature);
  }
}

TEST(Boxes, FarApartIsNoContact) {
  EXPECT_EQ(collide_boxes(box(1, 1), at(0, 0), box(1, 1), at(0, 3), 0.5).count, 0);
  EXPECT_EQ(collide_boxes(box(1, 1), at(0, 0), box(1, 1), at(3, 3, 0.3), 0.5).count, 0);
}

/// Whether two convex outlines overlap, by sampling: points of each box's border inside the other.
bool overlap_by_sampling(const SolidShape<double>& a, const Placement<double>& at_a,
                         const SolidShape<double>& b, const Placement<double>& at_b) {
  const auto border_inside = [](const SolidShape<double>& of, const Placement<double>& at_of,
                                const SolidShape<double>& in, const Placement<double>& at_in) {
    for (int i = 0; i < 4000; ++i) {
      const double t = -1 + 2.0 * (i % 1000) / 999;
      const Vec2d local = i < 1000   ? Vec2d{t * of.half.x, of.half.y}
                          : i < 2000 ? Vec2d{t * of.half.x, -of.half.y}
                          : i < 3000 ? Vec2d{of.half.x, t * of.half.y}
                                     : Vec2d{-of.half.x, t * of.half.y};
      const Vec2d p = at_in.rotation.inverse() * (at_of.center + at_of.rotation * local - at_in.center);
      if (std::abs(p.x) < in.half.x && std::abs(p.y) < in.half.y) return true;
    }
    return false;
  };
  return border_inside(a, at_a, b, at_b) || border_inside(b, at_b, a, at_a);
}

// Separating axes against a sampled overlap test, for boxes anywhere.
TEST(Boxes, OverlapAgreesWithSampling) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  int overlapping = 0;
  for (int i = 0; i < 300; ++i) {
    const auto a = box(0.5 + uniform(random), 0.5 + uniform(random));
    const auto b = box(0.5 + uniform(random), 0.5 + uniform(random));
    const auto at_a = at(0, 0, 6 * uniform(random));
    const auto at_b = at(2 * uniform(random) - 1, 2 * uniform(random) - 1, 6 * uniform(random));
    const auto m = collide_boxes(a, at_a, b, at_b, 0.0);
    const bool deep =
        m.count > 0 && std::fmin(m.points[0].separation, m.points[m.count - 1].separation) < -0.01;
    if (deep) {
      EXPECT_TRUE(overlap_by_sampling(a, at_a, b, at_b)) << i;
      ++overlapping;
    }
    if (m.count == 0) {
      EXPECT_FALSE(overlap_by_sampling(a, at_a, b, at_b)) << i;
    }
    // Moving b out along the normal by the depth leaves no overlap.
    if (m.count > 0) {
      const double depth = -std::fmin(m.points[0].separation, m.points[m.count - 1].separation);
      const Placement<double> moved{at_b.center + (depth + 1e-9) * m.normal, at_b.rotation};
      EXPECT_FALSE(overlap_by_sampling(a, at_a, b, moved)) << i;
    }
  }
  EXPECT_GT(overlapping, 100);
}

}  // namespace
}  // namespace plumb
