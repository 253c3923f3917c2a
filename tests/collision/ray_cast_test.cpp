#include <algorithm>
#include <cmath>

#include "engine/collision/distance/ray_cast.h"

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
class RayCast : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(RayCast, Reals);

constexpr Wide kDouble = std::numeric_limits<double>::epsilon();

/// The signed distance from a convex shape is a convex function along the ray: its first root lies before its
/// minimum. The normal is held against its definition: all of the shape lies behind the tangent.
template <class Real>
void check(const Convex<Real>& shape, Vec2<Real> from, Vec2<Real> way, const RayHit<Real>& got, int& hits) {
  const auto points = truth::points_of(shape);
  const Point o = from.template as<Wide>(), d = way.template as<Wide>();
  const auto height = [&](Wide t) { return truth::signed_distance(points, o + t * d) - shape.radius; };
  Wide scale = std::sqrt(length_squared(o)) + std::sqrt(length_squared(d)) + shape.radius;
  for (const Point& p : points) scale = std::max(scale, std::sqrt(length_squared(p)));
  const Wide rounding = 8 * kDouble * scale, ulp = std::numeric_limits<Real>::epsilon();

  if (height(0) <= rounding) {
    if (height(0) < -rounding) {
      ASSERT_FALSE(got.hit) << "from inside";
    }
    return;
  }
  const Wide lowest = truth::lowest_along(height);
  if (!got.hit) {
    ASSERT_GE(height(lowest), points.size() < 3 && shape.radius == 0 ? 0 : -rounding);
    return;
  }
  ++hits;
  const Wide tolerance = rounding + ulp * scale;
  const Point at = got.point.template as<Wide>(), n = got.normal.template as<Wide>();
  ASSERT_LE(height(lowest), rounding);
  ASSERT_TRUE(near(height(got.fraction), 0, tolerance));
  ASSERT_LE(got.fraction, lowest + tolerance / std::sqrt(length_squared(d)));
  ASSERT_LE(std::sqrt(length_squared(at - (o + Wide(got.fraction) * d))), tolerance);
  ASSERT_TRUE(near(length_squared(n), 1, 4 * ulp));
  ASSERT_LT(dot(n, d), tolerance);
  // On a small arc the normal has only as many digits as the point has on the arc.
  ASSERT_LE(truth::support(points, n) + shape.radius, dot(n, at) + tolerance);
}

TYPED_TEST(RayCast, AgreesWithTheSignedDistance) {
  using Real = TypeParam;
  Random random(1);
  constexpr int kCases = 10000;
  int hits = 0;
  for (int k = 0; k < kCases; ++k) {
    const double size = random.decade(-6, 6);
    const Shape<Real> shape = truth::random_shape<Real>(random, size);
    const Point from = size * random.uniform(0, 4) * random.direction();
    const Point to = random.chance(0.3) ? from + size * random.uniform(0, 8) * random.direction()
                                        : size * random.uniform(0, 1.2) * random.direction();
    const Wide farther = random.chance(0.3) ? random.decade(0, 3) : 1;
    const Vec2<Real> origin = from.as<Real>(), way = (farther * (to - from)).template as<Real>();
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_NO_FATAL_FAILURE(check<Real>(shape, origin, way, ray_cast<Real>(shape, origin, way), hits));
  }
  EXPECT_GT(hits, kCases / 5);
  EXPECT_LT(hits, kCases * 4 / 5);
}

TYPED_TEST(RayCast, ClosedForms) {
  using Real = TypeParam;
  const Shape<Real> box = truth::tight_aabb<Real>(1, 2), disc = truth::shape_of<Real>({{0, 0}}, 5),
                    capsule = truth::shape_of<Real>({{-4, 0}, {4, 0}}, 1),
                    round = truth::tight_aabb<Real>(1, 2, 0.5),
                    segment = truth::shape_of<Real>({{-1, 0}, {1, 0}});
  const auto cast = [](const Shape<Real>& shape, Vec2<Real> from, Vec2<Real> way) {
    return ray_cast<Real>(shape, from, way);
  };
  const auto expect = [](const RayHit<Real>& got, Real fraction, Vec2<Real> point, Vec2<Real> normal) {
    EXPECT_TRUE(got.hit);
    EXPECT_EQ(got.fraction, fraction);
    EXPECT_EQ(got.point, point);
    EXPECT_TRUE(near(got.normal.x, normal.x, std::numeric_limits<Real>::epsilon()));
    EXPECT_TRUE(near(got.normal.y, normal.y, std::numeric_limits<Real>::epsilon()));
  };
  expect(cast(box, {-5, 1}, {8, 0}), Real(0.5), {-1, 1}, {-1, 0});
  expect(cast(box, {0, 10}, {0, -8}), 1, {0, 2}, {0, 1});                              // its end just touches
  expect(cast(disc, {-11, 3}, {14, 0}), Real(0.5), {-4, 3}, {Real(-0.8), Real(0.6)});  // 3-4-5
  expect(cast(disc, {-10, 5}, {20, 0}), Real(0.5), {0, 5}, {0, 1});                    // a tangent
  expect(cast(capsule, {0, 5}, {0, -8}), Real(0.5), {0, 1}, {0, 1});
  expect(cast(capsule, {9, 0}, {-8, 0}), Real(0.5), {5, 0}, {1, 0});
  expect(cast(round, {Real(1.25), 6}, {0, -4}), (6 - 2 - std::sqrt(Real(0.1875))) / 4,
         {Real(1.25), 2 + std::sqrt(Real(0.1875))}, {Real(0.5), std::sqrt(Real(0.75))});
  expect(cast(segment, {0, 2}, {0, -4}), Real(0.5), {0, 0}, {0, 1});  // from either side
  expect(cast(segment, {0, -2}, {0, 4}), Real(0.5), {0, 0}, {0, -1});
  expect(cast(segment, {3, 0}, {-4, 0}), Real(0.5), {1, 0}, {1, 0});  // along it

  EXPECT_FALSE(cast(box, {-5, 1}, {3.5, 0}).hit);                  // too short
  EXPECT_FALSE(cast(box, {-5, 1}, {-8, 0}).hit);                   // away
  EXPECT_FALSE(cast(box, {-5, 3}, {8, 0}).hit);                    // above it, parallel to an edge
  EXPECT_FALSE(cast(box, {0, 0}, {8, 0}).hit);                     // from inside
  EXPECT_FALSE(cast(box, {1, 0}, {-8, 0}).hit);                    // from the surface
  EXPECT_FALSE(cast(box, {-5, 1}, {0, 0}).hit);                    // no motion
  EXPECT_FALSE(cast(round, {Real(1.4), Real(2.4)}, {-1, 1}).hit);  // outside the arc, above the edge
  EXPECT_FALSE(cast(disc, {-10, Real(5.00001)}, {20, 0}).hit);
  EXPECT_EQ(cast(box, {0, 0}, {8, 0}).fraction, 1);
}

// Rays through the corner that two edges share must not slip between them.
TYPED_TEST(RayCast, NoCrackAtCorners) {
  using Real = TypeParam;
  Random random(2);
  int hits = 0;
  for (int k = 0; k < 10000; ++k) {
    const Shape<Real> shape =
        truth::shape_of<Real>({random.direction(), 1.5 * random.direction(), 2 * random.direction()},
                              random.chance(0.5) ? random.decade(-7, -1) : 0);
    const auto points = truth::hull_of(truth::points_of<Real>(shape));
    // In a sliver an error across the ray is a large one along it.
    if (points.size() < 3 || cross(points[1] - points[0], points[2] - points[0]) < 0.5) continue;
    const Shape<Real> hull = truth::shape_of<Real>(points, shape.radius);
    // Inwards through a corner, towards the centre.
    const Point corner = points[random.below(3)],
                middle = (1 / Wide(3)) * (points[0] + points[1] + points[2]);
    const Vec2<Real> way = (2 * (middle - corner)).template as<Real>();
    const Vec2<Real> from = (corner - Wide(0.5) * way.template as<Wide>()).template as<Real>();
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_NO_FATAL_FAILURE(check<Real>(hull, from, way, ray_cast<Real>(hull, from, way), hits));
  }
  EXPECT_GT(hits, 2000);
}

TYPED_TEST(RayCast, OneSided) {
  using Real = TypeParam;
  const Shape<Real> segment = truth::shape_of<Real>({{-1, 0}, {1, 0}});  // its front is below
  const auto cast = [&](Vec2<Real> from, Vec2<Real> way) {
    return ray_cast_one_sided<Real>(segment, from, way);
  };
  EXPECT_TRUE(cast({0, -2}, {0, 4}).hit);
  EXPECT_EQ(cast({0, -2}, {0, 4}).fraction, Real(0.5));
  EXPECT_EQ(cast({0, -2}, {0, 4}).normal.y, -1);
  EXPECT_FALSE(cast({0, 2}, {0, -4}).hit);   // from behind
  EXPECT_FALSE(cast({0, -2}, {0, -4}).hit);  // away
  EXPECT_FALSE(cast({2, 0}, {-4, 0}).hit);   // along it
  EXPECT_FALSE(cast({0, 0}, {0, 4}).hit);    // from on it
  EXPECT_FALSE(cast({2, -2}, {0, 4}).hit);   // past its end
  EXPECT_TRUE(cast({-3, -2}, {4, 4}).hit);

  const Shape<Real> round = truth::shape_of<Real>({{-1, 0}, {1, 0}}, 0.5);
  EXPECT_TRUE((ray_cast<Real>(round, {2, Real(0.125)}, {-2, Real(0.125)}).hit));
  EXPECT_FALSE((ray_cast_one_sided<Real>(round, {2, Real(0.125)}, {-2, Real(0.125)}).hit));  // behind
}

// The signed distance is unique; the point is on the surface at that distance, along the normal.
TYPED_TEST(RayCast, NearestPointAndContains) {
  using Real = TypeParam;
  Random random(3);
  int inside = 0;
  for (int k = 0; k < 20000; ++k) {
    const double size = random.decade(-6, 6);
    const Shape<Real> shape = truth::random_shape<Real>(random, size);
    const auto points = truth::points_of<Real>(shape);
    const Point x = (size * random.uniform(0, 2.5) * random.direction());
    const Vec2<Real> point = x.as<Real>();
    const Point exact = point.template as<Wide>();
    Wide scale = std::sqrt(length_squared(exact)) + shape.radius;
    for (const Point& p : points) scale = std::max(scale, std::sqrt(length_squared(p)) + shape.radius);
    const Wide ulp = std::numeric_limits<Real>::epsilon(), rounding = 4 * kDouble * scale;
    const Wide depth = truth::signed_distance(points, exact) - shape.radius;
    const auto got = nearest_point<Real>(shape, point);
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_TRUE(near(got.distance, depth, ulp * std::abs(depth) + rounding));
    const Point at = got.point.template as<Wide>(), n = got.normal.template as<Wide>();
    const Wide tolerance = rounding + ulp * scale;
    ASSERT_TRUE(near(length_squared(n), 1, 4 * ulp));
    ASSERT_TRUE(near(truth::signed_distance(points, at), shape.radius, tolerance));
    ASSERT_LE(std::sqrt(length_squared(exact - Wide(got.distance) * n - at)), 2 * tolerance);
    if (std::abs(depth) > rounding) {
      ASSERT_EQ(contains<Real>(shape, point), depth < 0);
    }
    inside += depth < 0;
  }
  EXPECT_GT(inside, 2000);
}

TYPED_TEST(RayCast, ContainsItsSurface) {
  using Real = TypeParam;
  const Shape<Real> box = truth::tight_aabb<Real>(1, 2), disc = truth::shape_of<Real>({{0, 0}}, 5),
                    segment = truth::shape_of<Real>({{-1, 0}, {1, 0}}),
                    point = truth::shape_of<Real>({{3, 4}});
  EXPECT_TRUE((contains<Real>(box, {1, Real(0.3)})));
  EXPECT_TRUE((contains<Real>(box, {1, 2})));
  EXPECT_FALSE((contains<Real>(box, {1, std::nextafter(Real(2), Real(3))})));
  EXPECT_TRUE((contains<Real>(disc, {3, 4})));
  EXPECT_FALSE((contains<Real>(disc, {3, Real(4.00001)})));
  EXPECT_TRUE((contains<Real>(segment, {Real(0.5), 0})));
  EXPECT_FALSE((contains<Real>(segment, {Real(0.5), Real(1e-6)})));
  EXPECT_TRUE((contains<Real>(point, {3, 4})));
  const Shape<Real> slope = truth::shape_of<Real>({{0, 0}, {4, 4}});
  EXPECT_EQ((nearest_point<Real>(slope, {2, 2}).distance), 0);  // its normal is the segment's
  EXPECT_TRUE(near(nearest_point<Real>(slope, {2, 2}).normal.x, std::sqrt(Wide(0.5)),
                   std::numeric_limits<Real>::epsilon()));
  EXPECT_EQ((nearest_point<Real>(point, {3, 4}).distance), 0);
  EXPECT_EQ((length_squared(nearest_point<Real>(point, {3, 4}).normal)), 1);
}

}  // namespace
}  // namespace plumb
