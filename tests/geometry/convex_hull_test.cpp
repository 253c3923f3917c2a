#include "engine/geometry/convex_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "engine/scene/error.h"

namespace plumb {
namespace {

constexpr double kSizes[] = {1e-3, 1.0, 1e3};

std::vector<Vec2d> circle(int count, double radius, Vec2d center = {}) {
  std::vector<Vec2d> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    points.push_back(center + radius * Vec2d{std::cos(angle), std::sin(angle)});
  }
  return points;
}

void expect_refused(const std::vector<Vec2d>& points, const char* word) {
  try {
    convex_hull(points);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
    EXPECT_EQ(error.subject(), "shape");
    EXPECT_EQ(error.field(), "points");
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

/// Convex, counter-clockwise, unit normals outward, and every point inside or within `slack`.
void expect_hull_of(const Corners& hull, const std::vector<Vec2d>& points, double slack) {
  const std::size_t n = hull.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2d edge = hull[(i + 1) % n].point - hull[i].point;
    EXPECT_GT(cross(edge, hull[(i + 2) % n].point - hull[(i + 1) % n].point), 0);
    EXPECT_NEAR(length_squared(hull[i].normal), 1, 1e-15);
    EXPECT_NEAR(cross(perpendicular(hull[i].normal), edge), 0, 1e-15 * std::sqrt(length_squared(edge)));
    EXPECT_GT(dot(perpendicular(hull[i].normal), edge), 0);
    for (const Vec2d p : points) EXPECT_LE(dot(hull[i].normal, p - hull[i].point), slack);
  }
}

TEST(ConvexHull, OfRandomPointsHoldsThemAll) {
  std::mt19937_64 bits(5);
  const auto number = [&bits] { return static_cast<double>(bits() >> 11) * 0x1p-52 - 1; };
  for (const double size : kSizes)
    for (int trial = 0; trial < 300; ++trial) {
      std::vector<Vec2d> points;
      const Vec2d center{100 * size * number(), size};
      for (int i = 0; i < 3 + trial % 60; ++i) {
        const double x = number();
        points.push_back(center + size * Vec2d{x, number()});
      }
      const Corners hull = convex_hull(points);
      expect_hull_of(hull, points, 3e-5 * size);
      for (const Corner<double>& corner : hull)
        EXPECT_NE(std::find(points.begin(), points.end(), corner.point), points.end())
            << "corners are points";
    }
}

TEST(ConvexHull, SquareFromAnyOrderWithPointsInsideAndOnEdges) {
  for (const double size : kSizes) {
    const std::vector<Vec2d> points = {{size, size},     {0, 0},        {size / 2, size / 3}, {0, size},
                                       {size / 2, size}, {size, 0},     {0, size / 2},        {size, size},
                                       {0, 0},           {size / 4, 0}, {size, size / 2}};
    const Corners hull = convex_hull(points);
    ASSERT_EQ(hull.size(), 4u);
    EXPECT_EQ(hull[0].point, (Vec2d{0, 0}));
    EXPECT_EQ(hull[1].point, (Vec2d{size, 0}));
    EXPECT_EQ(hull[2].point, (Vec2d{size, size}));
    EXPECT_EQ(hull[3].point, (Vec2d{0, size}));
    EXPECT_EQ(hull[0].normal, (Vec2d{0, -1}));
    EXPECT_EQ(hull[1].normal, (Vec2d{1, 0}));
  }
}

// The rounding goes with the extent: the same outline is treated alike at a millimetre and a kilometre.
TEST(ConvexHull, CornersThatStandOutByMoreThanTheRoundingAreKept) {
  for (const double size : kSizes) {
    const auto corners_with = [size](double bump, double gap, double detail) {
      std::vector<Vec2d> points = {{0, 0}, {size, 0}, {size, size}, {0, size}};
      points.push_back({size / 2, -bump * size});
      points.push_back({size + gap * size, gap * size});
      return convex_hull(points, detail * size).size();
    };
    EXPECT_EQ(corners_with(1e-15, 1e-15, 0), 4u);
    EXPECT_EQ(corners_with(1e-14, 1e-15, 0), 5u);
    EXPECT_EQ(corners_with(1e-15, 1e-14, 0), 5u);
    EXPECT_EQ(corners_with(1e-14, 1e-14, 0), 6u);
    EXPECT_EQ(corners_with(3e-7, 3e-7, 1e-6), 4u);
    EXPECT_EQ(corners_with(3e-6, 3e-7, 1e-6), 5u);
    EXPECT_EQ(corners_with(3e-7, 3e-6, 1e-6), 5u);
  }
}

// Each corner of a fine arc stands out by less than the detail, all of them together by much more.
TEST(ConvexHull, NoDroppedCornerIsFartherAwayThanTheDetail) {
  for (const double detail : {1e-12, 1e-9, 1e-6, 2e-4}) {
    std::vector<Vec2d> points = {{-1, 1}, {1, 1}};
    for (int i = -500; i <= 500; ++i) {
      const double x = i / 500.0;
      points.push_back({x, 300 * detail * (x * x - 1)});
    }
    const Corners hull = convex_hull(points, detail);
    expect_hull_of(hull, points, 1.001 * detail);
    EXPECT_LT(hull.size(), 40u);
    EXPECT_GT(hull.size(), 8u);
  }
}

TEST(ConvexHull, TakesAsManyCornersAsAllowedAndNoMore) {
  EXPECT_EQ(convex_hull(circle(kMaxCorners, 1)).size(), 64u);
  expect_refused(circle(kMaxCorners + 1, 1), "65 corners");
  expect_refused(circle(100000, 1), "corners");
  // Many points are no harm when few are corners.
  std::vector<Vec2d> points = circle(8, 1);
  for (const Vec2d p : circle(1000, 0.9)) points.push_back(p);
  EXPECT_EQ(convex_hull(points).size(), 8u);
}

TEST(ConvexHull, RefusesWhatHasNoAreaOrIsNotFinite) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  expect_refused({}, "0 points");
  expect_refused({{1, 1}}, "1 points");
  expect_refused({{1, 1}, {2, 3}}, "line");
  expect_refused({{1, 1}, {2, 2}, {3, 3}, {4, 4}}, "line");
  expect_refused({{0, 0}, {1, 1e-6}, {2, 0}, {1, -1e-6}}, "line");
  expect_refused({{1, 1}, {1, 1}, {1, 1}}, "line");
  expect_refused({{0, 0}, {1, nan}, {1, 1}}, "finite");
  expect_refused({{0, 0}, {infinity, 0}, {1, 1}}, "finite");
  expect_refused({{0, 0}, {1e200, 0}, {1, 1e200}}, "1e100");
}

TEST(Corners, BoxHasExactlyOppositeNormals) {
  const Rotation<double> tilt{0.8, 0.6};
  const Corners box = box_corners(2, 1, {10, 20}, tilt);
  ASSERT_EQ(box.size(), 4u);
  // (-2, -1) turned by the angle of (4, 3)/5 is (-1, -2).
  EXPECT_NEAR(box[0].point.x, 9, 1e-14);
  EXPECT_NEAR(box[0].point.y, 18, 1e-14);
  EXPECT_EQ(box[1].normal, (Vec2d{0.8, 0.6}));
  for (int i = 0; i < 2; ++i) EXPECT_EQ(box[i].normal, -box[i + 2].normal);
  std::vector<Vec2d> points;
  for (const Corner<double>& corner : box) points.push_back(corner.point);
  expect_hull_of(box, points, 1e-14);
}

TEST(Corners, CapsuleAndDisc) {
  const Corners capsule = capsule_corners({1, 1}, {4, 5});
  ASSERT_EQ(capsule.size(), 2u);
  EXPECT_EQ(capsule[0].normal, (Vec2d{0.8, -0.6})) << "to the right of the way";
  EXPECT_EQ(capsule[1].normal, -capsule[0].normal);
  EXPECT_EQ(capsule_corners({1, 2}, {1, 2}).size(), 1u);
  ASSERT_EQ(disc_corner({3, 4}).size(), 1u);
  EXPECT_EQ(disc_corner({3, 4})[0].point, (Vec2d{3, 4}));
}

TEST(Corners, MoveAndTurn) {
  const Corners box = box_corners(2, 1);
  const Corners turned = transformed(box, {{5, 0}, {0, 1}});
  EXPECT_EQ(turned[0].point, (Vec2d{6, -2}));
  EXPECT_EQ(turned[0].normal, (Vec2d{1, 0}));
  EXPECT_EQ(translated(box, {1, 2})[0].point, (Vec2d{-1, 1}));
  EXPECT_EQ(translated(box, {1, 2})[0].normal, box[0].normal);
}

}  // namespace
}  // namespace plumb
