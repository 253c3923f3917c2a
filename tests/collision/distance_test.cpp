#include <algorithm>
#include <cmath>

#include "engine/collision/distance/distance.h"

#include <gtest/gtest.h>

#include "tests/collision/query_truth.h"

namespace plumb {
namespace {

namespace truth = query_truth;

using truth::Point;
using truth::Random;
using truth::Shape;
using truth::Wide;

template <class Real>
class Distance : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Distance, Reals);

constexpr Wide kDouble = std::numeric_limits<double>::epsilon();

template <class Real>
Wide extent(const Convex<Real>& shape) {
  Wide size = shape.radius;
  for (const Point& p : truth::points_of(shape))
    size = std::max(size, std::sqrt(length_squared(p)) + shape.radius);
  return size;
}

/// Holds a result against the signed distance of the difference hull, and its normal against the definition:
/// no direction parts the shapes farther, and this one parts them by as much.
template <class Real>
void check(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& pose,
           const DistanceResult<Real>& got) {
  const auto in_a = truth::points_of(a), in_b = truth::placed(b, truth::wide(pose));
  const Wide radius = Wide(a.radius) + Wide(b.radius);
  const Wide gap = truth::signed_distance(truth::difference_hull(in_a, in_b), {}) - radius;
  const Wide scale = extent(a) + extent(b) + std::sqrt(length_squared(truth::wide(pose).position));
  const Wide ulp = std::numeric_limits<Real>::epsilon();
  const Wide rounding = 6 * kDouble * scale, tolerance = rounding + ulp * scale;
  ASSERT_TRUE(truth::near(got.distance, std::max(gap, Wide(0)), ulp * std::max(gap, Wide(0)) + rounding));
  const Point n = got.normal.template as<Wide>(), pa = got.point_a.template as<Wide>(),
              pb = got.point_b.template as<Wide>();
  ASSERT_TRUE(truth::near(length_squared(n), 1, 4 * ulp));
  ASSERT_TRUE(truth::near(truth::gap_along(in_a, in_b, n) - radius, gap, tolerance));
  ASSERT_TRUE(truth::near(dot(pb - pa, n), gap, tolerance));
  ASSERT_LE(std::abs(cross(pb - pa, n)), tolerance);
  ASSERT_TRUE(truth::near(truth::signed_distance(in_a, pa) - a.radius, 0, tolerance));
  ASSERT_TRUE(truth::near(truth::signed_distance(in_b, pb) - b.radius, 0, tolerance));
}

TYPED_TEST(Distance, AgreesWithTheDifferenceHull) {
  using Real = TypeParam;
  Random random(1);
  int most = 0, overlaps = 0;
  constexpr int kCases = 20000;
  for (int k = 0; k < kCases; ++k) {
    const double size = random.decade(-6, 6), other = size * random.decade(-3, 0);
    const Shape<Real> a = truth::random_shape<Real>(random, size),
                      b = truth::random_shape<Real>(random, other);
    const double away = size * (random.chance(0.2) ? random.decade(0, 4) : random.uniform(0, 4));
    const Pose<Real> pose{(away * random.direction()).template as<Real>(), random.rotation<Real>()};
    const DistanceResult<Real> got = distance<Real>(a, b, pose);
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_NO_FATAL_FAILURE(check<Real>(a, b, pose, got));
    most = std::max(most, got.iterations);
    overlaps += got.distance > 0 ? 0 : 1;
  }
  EXPECT_LE(most, 10);
  EXPECT_GT(overlaps, kCases / 20);
  EXPECT_LT(overlaps, kCases / 2);
}

// Moved to where they touch, but for a rounding or a little more: the direction of two corners is mostly
// rounding then, but what is returned still parts the shapes.
TYPED_TEST(Distance, NearlyTouching) {
  using Real = TypeParam;
  Random random(8);
  int apart = 0;
  for (int k = 0; k < 20000; ++k) {
    const double size = random.decade(-6, 6);
    const Shape<Real> a = truth::random_shape<Real>(random, size),
                      b = truth::random_shape<Real>(random, size);
    Pose<Real> pose{(size * random.uniform(0, 4) * random.direction()).template as<Real>(),
                    random.rotation<Real>()};
    const Convex<Real> hull_a{a.view().corners, a.view().count, 0},
        hull_b{b.view().corners, b.view().count, 0};
    const auto before = distance<Real>(hull_a, hull_b, pose);
    pose.position -= (before.distance - static_cast<Real>(size * random.decade(-19, -5))) * before.normal;
    const auto got = distance<Real>(hull_a, hull_b, pose);
    const auto in_a = truth::points_of(hull_a), in_b = truth::placed(hull_b, truth::wide(pose));
    const Wide depth = truth::signed_distance(truth::difference_hull(in_a, in_b), {}),
               gap = std::max(depth, Wide(0));
    const Wide scale =
        extent(hull_a) + extent(hull_b) + std::sqrt(length_squared(truth::wide(pose).position));
    const Wide ulp = std::numeric_limits<Real>::epsilon(), rounding = 6 * kDouble * scale;
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_TRUE(before.distance == 0 || truth::near(got.distance, gap, rounding + ulp * gap));
    ASSERT_LE(got.iterations, 12);
    const Point n = got.normal.template as<Wide>();
    if (before.distance == 0 || (a.corners.size() < 3 && b.corners.size() < 3)) continue;
    ++apart;
    ASSERT_GE(truth::gap_along(in_a, in_b, n), std::min(depth, depth / 2) - rounding - ulp * scale);
  }
  EXPECT_GT(apart, 10000);
}

TYPED_TEST(Distance, SixtyFourCorners) {
  using Real = TypeParam;
  Random random(2);
  for (int k = 0; k < 60; ++k) {
    std::vector<Point> ring;
    for (int i = 0; i < kMaxCorners; ++i)
      ring.push_back(
          {std::cos(2 * truth::kPi * i / kMaxCorners), std::sin(2 * truth::kPi * i / kMaxCorners)});
    const Shape<Real> a = truth::shape_of<Real>(ring), b = truth::shape_of<Real>(ring, 0.25);
    const Pose<Real> pose{(random.uniform(0, 4) * random.direction()).template as<Real>(),
                          random.rotation<Real>()};
    ASSERT_NO_FATAL_FAILURE(check<Real>(a, b, pose, distance<Real>(a, b, pose)));
  }
}

// Boxes that touch along an edge, at a corner, or corner to edge: exact in binary, so the distance is exactly
// what it is on paper.
TYPED_TEST(Distance, TouchingIsExact) {
  using Real = TypeParam;
  const Shape<Real> box = truth::tight_aabb<Real>(1, 1), disc = truth::shape_of<Real>({{0, 0}}, 0.5);
  const auto at = [&](const Shape<Real>& b, Real x, Real y) {
    return distance<Real>(box, b, {{x, y}, {}}).distance;
  };
  EXPECT_EQ(at(box, 2, 0), 0);
  EXPECT_EQ(at(box, 2, Real(0.3)), 0);
  EXPECT_EQ(at(box, 2, 2), 0);
  EXPECT_EQ(at(box, 2.5, 0.25), 0.5);
  EXPECT_EQ(at(box, 5, 6), 5);
  EXPECT_EQ(at(disc, 1.5, 0.25), 0);
  EXPECT_EQ(at(disc, 1.75, 0.25), 0.25);
  EXPECT_EQ(at(disc, 4, 5), 4.5);
  for (std::uint8_t i = 0; i < 4; ++i)  // wherever the search begins
    for (std::uint8_t j = 0; j < 4; ++j)
      for (const Real x : {Real(-2), Real(2)})
        for (const Real y : {Real(-2), Real(0), Real(2)}) {
          SimplexCache cache{1, {i, 0}, {j, 0}};
          const auto got = distance<Real>(box, box, {{x, y}, {}}, &cache);
          EXPECT_EQ(got.distance, 0);
          EXPECT_EQ(length_squared(got.normal), 1);
          EXPECT_EQ(got.point_a, got.point_b);
        }
}

// The normal of an edge has all of its digits at any distance.
TYPED_TEST(Distance, NormalFromFarAway) {
  using Real = TypeParam;
  const Shape<Real> small = truth::tight_aabb<Real>(1e-3, 1e-3), point = truth::shape_of<Real>({{0, 0}});
  for (const double angle : {0.1, 0.7, 2.0}) {
    const Rotation<Real> q{static_cast<Real>(std::cos(angle)), static_cast<Real>(std::sin(angle))};
    const auto got = distance<Real>(point, small, {{Real(1e3) * q.c, Real(1e3) * q.s}, q});
    EXPECT_TRUE(truth::near(got.normal.x, q.c, 4 * std::numeric_limits<Real>::epsilon()));
    EXPECT_TRUE(truth::near(got.normal.y, q.s, 4 * std::numeric_limits<Real>::epsilon()));
  }
}

TYPED_TEST(Distance, NormalOfATouchingEdgeIsTheEdgesOwn) {
  using Real = TypeParam;
  const Shape<Real> box = truth::tight_aabb<Real>(1, 1);
  for (const Real gap : {Real(0), 4 * std::numeric_limits<Real>::epsilon(), Real(-0x1p-20), Real(0x1p-20)}) {
    const auto got = distance<Real>(box, box, {{2 + gap, Real(0.3)}, {}});
    EXPECT_EQ(got.normal.x, 1);
    EXPECT_EQ(got.normal.y, 0);
    EXPECT_EQ(got.point_a.x, 1);
    EXPECT_EQ(got.point_b.x, 1 + gap);
  }
}

TYPED_TEST(Distance, DegenerateShapes) {
  using Real = TypeParam;
  const Shape<Real> point = truth::shape_of<Real>({{0, 0}}),
                    segment = truth::shape_of<Real>({{-1, 0}, {1, 0}}),
                    twice = truth::shape_of<Real>({{1, 1}, {1, 1}}), box = truth::tight_aabb<Real>(2, 2);
  const Rotation<Real> quarter{0, 1};
  const struct {
    const Shape<Real>*a, *b;
    Pose<Real> pose;
  } cases[] = {
      {&segment, &segment, {{Real(0.25), 0}, quarter}},   // crossing
      {&segment, &segment, {{Real(0.5), 0}, {}}},         // collinear, overlapping
      {&segment, &segment, {{2, 0}, {}}},                 // collinear, end to end
      {&segment, &segment, {{3, 0}, {}}},                 // collinear, apart
      {&segment, &segment, {{Real(0.5), 1}, {}}},         // parallel
      {&segment, &segment, {}},                           // the same
      {&segment, &point, {{Real(0.5), 0}, {}}},           // on it
      {&segment, &point, {{Real(0.5), Real(1e-6)}, {}}},  // just off it
      {&segment, &point, {{2, 1}, {}}},
      {&box, &point, {{1, 0}, {}}},    // inside
      {&box, &point, {{2, 2}, {}}},    // on the corner
      {&box, &segment, {{0, 1}, {}}},  // nested
      {&box, &box, {}},                // the same
      {&twice, &box, {{5, 0}, {}}},    // corners that coincide
      {&twice, &twice, {{1, 0}, {}}},
  };
  for (const auto& it : cases) {
    ASSERT_NO_FATAL_FAILURE(check<Real>(*it.a, *it.b, it.pose, distance<Real>(*it.a, *it.b, it.pose)));
    const Pose<Real> back{-(it.pose.rotation.inverse() * it.pose.position), it.pose.rotation.inverse()};
    ASSERT_NO_FATAL_FAILURE(check<Real>(*it.b, *it.a, back, distance<Real>(*it.b, *it.a, back)));
  }
  for (const Shape<Real>* shape : {&point, &twice}) {  // the direction is open: up, but it is one
    const auto got = distance<Real>(*shape, *shape, {});
    EXPECT_EQ(got.distance, 0);
    EXPECT_EQ(length_squared(got.normal), 1);
  }
}

TYPED_TEST(Distance, NearlyParallelEdges) {
  using Real = TypeParam;
  Random random(3);
  for (int k = 0; k < 5000; ++k) {
    const Shape<Real> a = truth::tight_aabb<Real>(1, random.decade(-4, 0)),
                      b = truth::tight_aabb<Real>(1, 0.5);
    const double angle = random.decade(-18, -2), x = random.uniform(-2.5, 2.5);
    const double gap = random.chance(0.5) ? random.decade(-17, 0) : -random.decade(-17, -2);
    const Pose<Real> pose{{static_cast<Real>(x), static_cast<Real>(a.corners[2].point.y + 0.5 + gap)},
                          {static_cast<Real>(std::cos(angle)), static_cast<Real>(std::sin(angle))}};
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_NO_FATAL_FAILURE(check<Real>(a, b, pose, distance<Real>(a, b, pose)));
  }
}

// A corner cut by a tiny edge, seen along nearly the edge's normal: a step along it shortens the distance by
// less than its rounding, and yet the search is not at its end.
TYPED_TEST(Distance, TinyEdges) {
  using Real = TypeParam;
  Random random(4);
  for (int k = 0; k < 5000; ++k) {
    const double depth = random.decade(-12, -4), side = random.decade(-10, 0);
    const Shape<Real> b =
        truth::shape_of<Real>({{0, 0}, {side, depth * random.uniform(0.9, 1.1)}, {1, depth}, {0.5, 1}});
    const Shape<Real> a = truth::shape_of<Real>({{-random.uniform(0, 1) * side, 0}, {0, -1}});
    const Pose<Real> pose{{0, static_cast<Real>(random.decade(-8, 1))}, {}};
    SCOPED_TRACE(testing::Message() << "case " << k);
    const auto hull = truth::hull_of(truth::points_of<Real>(b));
    if (hull.size() < 4) continue;  // not convex
    ASSERT_NO_FATAL_FAILURE(check<Real>(a, b, pose, distance<Real>(a, b, pose)));
  }
}

TYPED_TEST(Distance, SizesAMillionTimesApart) {
  using Real = TypeParam;
  Random random(5);
  for (int k = 0; k < 5000; ++k) {
    const double size = random.decade(0, 6), other = random.decade(-6, 0);
    const Shape<Real> a = truth::random_shape<Real>(random, size),
                      b = truth::random_shape<Real>(random, other);
    const double away = size * random.uniform(0, 2);
    const Pose<Real> pose{(away * random.direction()).template as<Real>(), random.rotation<Real>()};
    ASSERT_NO_FATAL_FAILURE(check<Real>(a, b, pose, distance<Real>(a, b, pose)));
  }
}

// Sizes beyond all reason, and corners that coincide: numbers, always.
TYPED_TEST(Distance, NothingBreaksIt) {
  using Real = TypeParam;
  Random random(7);
  for (int k = 0; k < 20000; ++k) {
    const double size = random.decade(-18, 18);
    Shape<Real> a = truth::random_shape<Real>(random, size, kMaxCorners),
                b = truth::random_shape<Real>(random, size * random.decade(-15, 0), kMaxCorners);
    if (random.chance(0.3)) a.corners.back() = a.corners.front();
    if (random.chance(0.3)) b.corners.assign(b.corners.size(), b.corners.front());
    const Pose<Real> pose{(size * random.decade(-15, 15) * random.direction()).template as<Real>(),
                          random.rotation<Real>()};
    const auto got = distance<Real>(a, b, pose);
    ASSERT_TRUE(got.distance >= 0 && std::isfinite(got.distance));
    ASSERT_TRUE(std::isfinite(got.point_a.x + got.point_a.y) && std::isfinite(got.point_b.x + got.point_b.y));
    ASSERT_TRUE(truth::near(length_squared(got.normal), 1, 1e-6));
    ASSERT_LE(got.iterations, 20);
  }
}

// From where the last search ended, the next one gives the same answer in fewer iterations; a cache of
// another pair does no harm.
TYPED_TEST(Distance, CacheChangesNothingButTheCost) {
  using Real = TypeParam;
  Random random(6);
  int cold = 0, warm = 0;
  for (int k = 0; k < 300; ++k) {
    const Shape<Real> a = truth::random_shape<Real>(random, 1, 20),
                      b = truth::random_shape<Real>(random, 1, 20);
    const Point way = 0.01 * random.direction(), from = 3 * random.direction();
    SimplexCache cache;
    if (k % 10 == 0) cache = {2, {63, 7}, {1, 63}};
    const double spin = random.uniform(-0.1, 0.1);
    for (int step = 0; step < 50; ++step) {
      const Pose<Real> pose{
          (from + Wide(step) * way).template as<Real>(),
          {static_cast<Real>(std::cos(step * spin)), static_cast<Real>(std::sin(step * spin))}};
      const auto got = distance<Real>(a, b, pose, &cache), plain = distance<Real>(a, b, pose);
      ASSERT_NO_FATAL_FAILURE(check<Real>(a, b, pose, got));
      cold += plain.iterations, warm += got.iterations;
    }
  }
  EXPECT_LT(warm, 0.8 * cold);
}

}  // namespace
}  // namespace plumb
