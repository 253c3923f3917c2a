#include <algorithm>
#include <cmath>

#include "engine/collision/distance/shape_cast.h"

#include <gtest/gtest.h>

#include "tests/collision/query_truth.h"

namespace plumb {
namespace {

namespace truth = query_truth;

using truth::near;
using truth::Point;
using truth::Random;
using truth::Shape;
using truth::Wide;

template <class Real>
class ShapeCast : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ShapeCast, Reals);

constexpr Wide kDouble = std::numeric_limits<double>::epsilon();

struct Counts {
  int hits = 0, misses = 0, overlaps = 0;
};

/// b moved by t d is as far from a as the point -t d from the difference hull: a convex function of t, with
/// its first root before its minimum.
template <class Real>
void check(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& pose, Vec2<Real> way,
           const CastResult<Real>& got, Counts& counts) {
  const auto in_a = truth::points_of(a), in_b = truth::placed(b, truth::wide(pose));
  const auto hull = truth::difference_hull(in_a, in_b);
  const Wide radius = Wide(a.radius) + Wide(b.radius);
  const Point d = way.template as<Wide>();
  const auto gap = [&](Wide t) { return truth::signed_distance(hull, -t * d) - radius; };
  Wide scale = std::sqrt(length_squared(d)) + radius;
  for (const Point& p : hull) scale = std::max(scale, std::sqrt(length_squared(p)));
  for (const Point& p : in_a) scale = std::max(scale, std::sqrt(length_squared(p)));
  const Wide rounding = 32 * kDouble * scale, ulp = std::numeric_limits<Real>::epsilon();

  ASSERT_TRUE(got.fraction >= 0 && got.fraction <= 1);
  if (gap(0) < -rounding) {
    ++counts.overlaps;
    ASSERT_TRUE(got.hit && got.overlapped);
    ASSERT_EQ(got.fraction, 0);
    return;
  }
  if (gap(0) <= rounding) return;  // touching: see the closed forms
  ASSERT_FALSE(got.overlapped);
  const Wide lowest = truth::lowest_along(gap);
  if (!got.hit) {
    ++counts.misses;
    ASSERT_EQ(got.fraction, 1);
    ASSERT_GE(gap(lowest), hull.size() < 3 && radius == 0 ? 0 : -rounding);
    return;
  }
  ++counts.hits;
  const Wide tolerance = rounding + ulp * scale;
  ASSERT_LE(gap(lowest), rounding);
  ASSERT_TRUE(near(gap(got.fraction), 0, rounding + ulp * std::sqrt(length_squared(d))));
  ASSERT_LE(got.fraction, lowest + tolerance / std::sqrt(length_squared(d)));
  const Point at = got.point.template as<Wide>(), n = got.normal.template as<Wide>();
  ASSERT_TRUE(near(length_squared(n), 1, 4 * ulp));
  ASSERT_TRUE(near(truth::signed_distance(in_a, at), a.radius, tolerance));
  std::vector<Point> moved = in_b;
  for (Point& p : moved) p += Wide(got.fraction) * d;
  ASSERT_TRUE(near(truth::signed_distance(moved, at), b.radius, tolerance));
  ASSERT_GE(truth::gap_along(in_a, moved, n), radius - tolerance);
}

TYPED_TEST(ShapeCast, AgreesWithTheDifferenceHull) {
  using Real = TypeParam;
  Random random(1);
  Counts counts;
  for (int k = 0; k < 8000; ++k) {
    const double size = random.decade(-6, 6), other = size * random.decade(-3, 0);
    const Shape<Real> a = truth::random_shape<Real>(random, size),
                      b = truth::random_shape<Real>(random, other);
    const Point from = size * random.uniform(0, 5) * random.direction();
    const Point to = size * random.uniform(0, 2) * random.direction();
    const Wide farther = random.chance(0.3) ? random.decade(0, 4) : 1;
    const Pose<Real> pose{from.as<Real>(), random.rotation<Real>()};
    const Vec2<Real> way = (farther * (to - from)).template as<Real>();
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_NO_FATAL_FAILURE(check<Real>(a, b, pose, way, shape_cast<Real>(a, b, pose, way), counts));
  }
  EXPECT_GT(counts.hits, 1500);
  EXPECT_GT(counts.misses, 1500);
  EXPECT_GT(counts.overlaps, 300);
}

TYPED_TEST(ShapeCast, ClosedForms) {
  using Real = TypeParam;
  const Shape<Real> box = truth::tight_aabb<Real>(1, 1), disc = truth::shape_of<Real>({{0, 0}}, 2),
                    big = truth::shape_of<Real>({{0, 0}}, 3), point = truth::shape_of<Real>({{0, 0}});
  const auto cast = [](const Shape<Real>& a, const Shape<Real>& b, Vec2<Real> from, Vec2<Real> way) {
    return shape_cast<Real>(a, b, {from, {}}, way);
  };
  const Real ulp = std::numeric_limits<Real>::epsilon();
  EXPECT_TRUE(near(cast(box, box, {6, 1}, {-8, 0}).fraction, 0.5, ulp));
  EXPECT_TRUE(near(cast(big, disc, {-11, 3}, {14, 0}).fraction, 0.5, ulp));  // 3-4-5
  EXPECT_TRUE(near(cast(box, disc, {0, 7}, {0, -8}).fraction, 0.5, ulp));
  // A tangent: two discs at the sum of their radii. The gap is quadratic in the way there.
  const auto tangent = cast(big, disc, {-10, 5}, {20, 0});
  if (tangent.hit) {
    EXPECT_TRUE(near(tangent.fraction, 0.5, 1e-7));
  }
  EXPECT_FALSE(cast(big, disc, {-10, Real(5.00001)}, {20, 0}).hit);
  EXPECT_TRUE(cast(big, disc, {-10, Real(4.99999)}, {20, 0}).hit);

  EXPECT_FALSE(cast(box, box, {6, 1}, {Real(-3.99), 0}).hit);  // too short
  EXPECT_FALSE(cast(box, box, {6, 1}, {8, 0}).hit);            // away
  EXPECT_FALSE(cast(box, box, {6, 1}, {0, 0}).hit);            // no motion
  EXPECT_FALSE(cast(point, point, {1, 0}, {0, 1}).hit);
  // Touching: into it, along it, away from it.
  EXPECT_TRUE(cast(box, box, {2, 1}, {-1, 0}).hit);
  EXPECT_FALSE(cast(box, box, {2, 1}, {-1, 0}).overlapped);
  EXPECT_EQ(cast(box, box, {2, 1}, {-1, 0}).fraction, 0);
  EXPECT_FALSE(cast(box, box, {2, 1}, {0, 1}).hit);
  EXPECT_FALSE(cast(box, box, {2, 1}, {1, 0}).hit);
  // Overlapping: also without a motion.
  for (const Vec2<Real> way : {Vec2<Real>{0, 0}, Vec2<Real>{5, 0}}) {
    const auto inside = cast(box, box, {1, Real(0.25)}, way);
    EXPECT_TRUE(inside.hit && inside.overlapped);
    EXPECT_EQ(inside.fraction, 0);
    EXPECT_EQ(inside.normal.x, 1);
  }
}

// 10^8 m in one cast through a wall of 1 mm.
TYPED_TEST(ShapeCast, FastThroughAThinWall) {
  using Real = TypeParam;
  const Shape<Real> wall = truth::tight_aabb<Real>(0.0005, 10),
                    bullet = truth::shape_of<Real>({{0, 0}}, 0.01);
  const auto got = shape_cast<Real>(wall, bullet, {{-5e7, Real(0.3)}, {}}, {Real(1e8), 0});
  ASSERT_TRUE(got.hit);
  EXPECT_TRUE(near(got.fraction, 0.5 - 0.0105e-8, std::numeric_limits<Real>::epsilon()));
  EXPECT_TRUE(near(got.point.x, -0.0005, 1e-7));
  EXPECT_TRUE(near(got.point.y, Real(0.3), 1e-7));
}

}  // namespace
}  // namespace plumb
