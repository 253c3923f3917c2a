#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "tests/collision/convex_truth.h"

namespace plumb {
namespace {

using truth::Dice;
using truth::Solid;

template <class Real = double>
Pose<Real> at(double x, double y, double angle = 0) {
  const Rotation<double> q = rotation_of(angle);
  return {Vec2d{x, y}.as<Real>(), {static_cast<Real>(q.c), static_cast<Real>(q.s)}};
}

template <class Real>
ContactManifold<Real> collide(const Solid<Real>& a, const Solid<Real>& b, const Pose<Real>& pose,
                              double reach = 0.02) {
  return collide_convex(a.view(), b.view(), pose, static_cast<Real>(reach), pose.position);
}

template <class Real>
std::set<int> features(const ContactManifold<Real>& manifold) {
  std::set<int> out;
  for (int i = 0; i < manifold.count; ++i) out.insert(manifold.points[i].feature);
  return out;
}

const Solid<double> kBox(box_corners(0.5, 0.5), 0), kDisc(disc_corner({}), 0.5);
const Solid<double> kRounded(box_corners(0.4, 0.4), 0.1);
const Solid<double> kCapsule(capsule_corners({-1, 0}, {1, 0}), 0.25);

void expect_points(const ContactManifold<double>& found, Vec2d normal, std::vector<Vec2d> points,
                   double separation) {
  ASSERT_EQ(found.count, static_cast<int>(points.size()));
  EXPECT_NEAR(found.normal.x, normal.x, 1e-15);
  EXPECT_NEAR(found.normal.y, normal.y, 1e-15);
  for (const Vec2d expected : points) {
    double nearest = 1;
    for (int i = 0; i < found.count; ++i) {
      nearest = std::min(nearest, std::sqrt(length_squared(found.points[i].point - expected)));
      EXPECT_NEAR(found.points[i].separation, separation, 1e-15);
    }
    EXPECT_LT(nearest, 2e-15);
  }
}

TEST(Discs, AlongTheLineOfCentres) {
  expect_points(collide(kDisc, Solid<double>(disc_corner({}), 0.25), at(0.6 * 0.74, 0.8 * 0.74)), {0.6, 0.8},
                {0.495 * Vec2d{0.6, 0.8}}, -0.01);
  EXPECT_EQ(collide(kDisc, kDisc, at(1.03, 0)).count, 0) << "out of reach";
  EXPECT_EQ(collide(kDisc, kDisc, at(1.01, 0)).count, 1) << "speculative";
}

TEST(DiscAndBox, FaceCornerInside) {
  expect_points(collide(kBox, kDisc, at(0.3, 0.99)), {0, 1}, {{0.3, 0.495}}, -0.01);
  const double diagonal = std::sqrt(0.5);
  expect_points(collide(kBox, kDisc, at(0.5 + 0.49 * diagonal, 0.5 + 0.49 * diagonal)), {diagonal, diagonal},
                {{0.5 - 0.005 * diagonal, 0.5 - 0.005 * diagonal}}, -0.01);
  // A centre inside leaves by the nearest face: 0.1 to the face and the radius more.
  expect_points(collide(kBox, kDisc, at(-0.4, 0.1)), {-1, 0}, {{-0.2, 0.1}}, -0.6);
}

TEST(Capsules, ParallelOnesTouchInTwoPoints) {
  expect_points(collide(kCapsule, kCapsule, at(0.5, 0.49)), {0, 1}, {{-0.5, 0.245}, {1, 0.245}}, -0.01);
  expect_points(collide(kCapsule, kCapsule, at(-0.5, -0.49, M_PI)), {0, -1}, {{-1, -0.245}, {0.5, -0.245}},
                -0.01);
}

TEST(Capsules, EndToEndAndCrossed) {
  expect_points(collide(kCapsule, kCapsule, at(2.49, 0)), {1, 0}, {{1.245, 0}}, -0.01);
  const auto tee = collide(kCapsule, kCapsule, at(0.3, 1.49, M_PI / 2));
  ASSERT_EQ(tee.count, 1);
  EXPECT_EQ(tee.normal, (Vec2d{0, 1}));
  EXPECT_NEAR(tee.points[0].separation, -0.01, 1e-15);
  // Crossed with 0.2 of b below a's axis: the way out is up by 0.2 and both radii.
  const auto crossed = collide(kCapsule, kCapsule, at(0.3, 0.8, M_PI / 2));
  ASSERT_GE(crossed.count, 1);
  EXPECT_NEAR(crossed.normal.y, 1, 1e-15);
  EXPECT_NEAR(crossed.points[0].separation, -0.7, 1e-15);
}

// An end that lies on the other's axis tells no side: the rest of its capsule does.
TEST(Capsules, AnEndOnTheOthersAxisLeavesToItsOwnSide) {
  for (const double off : {-1e-12, 0.0, 1e-12})
    for (const double side : {-1.0, 1.0}) {
      const auto manifold = collide(kCapsule, kCapsule, at(0.3, side + off, M_PI / 2));
      ASSERT_GE(manifold.count, 1);
      EXPECT_NEAR(manifold.normal.y, side, 1e-15);
      EXPECT_NEAR(manifold.points[0].separation, -0.5, 1e-11);
    }
}

TEST(Capsules, LieOnBoxesWithTwoPoints) {
  const Solid<double> table(box_corners(3, 0.5), 0);
  expect_points(collide(table, kCapsule, at(1, 0.74)), {0, 1}, {{0, 0.495}, {2, 0.495}}, -0.01);
  expect_points(collide(kCapsule, table, at(0, -0.74)), {0, -1}, {{-1, -0.245}, {1, -0.245}}, -0.01);
}

TEST(Boxes, OnEachOtherWithTwoPoints) {
  expect_points(collide(kBox, kBox, at(0, 0.99)), {0, 1}, {{-0.5, 0.495}, {0.5, 0.495}}, -0.01);
  expect_points(collide(kBox, kBox, at(0.7, 1.005)), {0, 1}, {{0.2, 0.5025}, {0.5, 0.5025}}, 0.005);
  expect_points(collide(kBox, kBox, at(-0.99, 0.4, M_PI)), {-1, 0}, {{-0.495, -0.1}, {-0.495, 0.5}}, -0.01);
  expect_points(collide(kRounded, kRounded, at(0.2, 0.99)), {0, 1}, {{-0.2, 0.495}, {0.4, 0.495}}, -0.01);
}

TEST(Boxes, CornersApartGiveTheDirectionBetweenThem) {
  expect_points(collide(kBox, kBox, at(1.006, 1.008)), {0.6, 0.8}, {{0.503, 0.504}}, 0.01);
  // Rounded ones also where they overlap: the hulls' corners are 0.19 apart.
  expect_points(collide(kRounded, kRounded, at(0.8 + 0.6 * 0.19, 0.8 + 0.8 * 0.19)), {0.6, 0.8},
                {Vec2d{0.4, 0.4} + 0.095 * Vec2d{0.6, 0.8}}, -0.01);
}

// The lower side ends right above the start of the other's upper side, or a rounding before it: the corners
// there are nearest, not those at the far ends, which lie as deep.
TEST(RoundedPolygons, SidesThatJustMissTouchAtTheNearCorners) {
  const Solid<double> tile(box_corners(0.5, 0.5), 0);
  for (const double miss : {0.0, 1e-15, -1e-15, 1e-9}) {
    for (const double gap : {0.0, -0.005, 0.01}) {
      const Pose<double> pose = at(-0.9 - miss, 1 + gap);
      for (const auto& [found, x] : {std::pair{collide(tile, kRounded, pose, 0.1), -0.5},
                                     std::pair{collide(kRounded, tile, pose, 0.1), -0.4}}) {
        ASSERT_GT(found.count, 0) << miss << ' ' << gap;
        EXPECT_NEAR(found.normal.y, 1, 1e-7) << miss << ' ' << gap;
        for (int i = 0; i < found.count; ++i) {
          EXPECT_NEAR(found.points[i].point.x, x, 1e-7) << miss << ' ' << gap;
          EXPECT_NEAR(found.points[i].separation, gap, 1e-7) << miss << ' ' << gap;
        }
      }
    }
  }
}

// Points at rest keep their feature ids: trembling by roundings must not change them, on top of each other,
// overhanging, in a brick wall and on a broad floor, hovering or sunk in.
template <class Real>
void expect_steady_names() {
  const Solid<Real> brick(box_corners(0.5, 0.25), 0), rounded(box_corners(0.4, 0.15), 0.1);
  const Solid<Real> floor(box_corners(20, 0.25), 0), capsule(capsule_corners({-0.5, 0}, {0.5, 0}), 0.25);
  const Solid<Real> hexagon(
      convex_hull(std::vector<Vec2d>{
          {-0.5, 0}, {-0.25, -0.25}, {0.25, -0.25}, {0.5, 0}, {0.25, 0.25}, {-0.25, 0.25}}),
      0);
  Dice dice(31);
  const double tremble = 4 * double{std::numeric_limits<Real>::epsilon()};
  for (const Solid<Real>& below : {brick, rounded, floor, hexagon})
    for (const Solid<Real>& above : {brick, rounded, capsule, hexagon})
      for (const double overhang : {0.0, 0.2, -0.37})
        for (const double gap : {-0.003, 0.0, 0.003}) {
          std::set<int> first;
          for (int i = 0; i < 60; ++i) {
            const auto manifold =
                collide(below, above,
                        at<Real>(overhang + dice.number(-tremble, tremble),
                                 0.5 + gap + dice.number(-tremble, tremble), dice.number(-tremble, tremble)));
            ASSERT_EQ(manifold.count, 2);
            EXPECT_NEAR(manifold.normal.y, 1, 1e-6);
            EXPECT_EQ(features(manifold).size(), 2u) << "two points, two names";
            if (i == 0) first = features(manifold);
            EXPECT_EQ(features(manifold), first) << overhang << ' ' << gap;
          }
        }
}

TEST(Names, AreSteadyInRest) {
  expect_steady_names<float>();
  expect_steady_names<double>();
}

// Nearly parallel faces: the normal is a's own, to the bit, whichever is deeper by a little, apart or not.
TEST(Normals, OfTheFirstShapeInRest) {
  const Rotation<double> tilt = rotation_of(0.3);
  const Corners hexagon = convex_hull(
      std::vector<Vec2d>{{-0.5, 0}, {-0.25, -0.25}, {0.25, -0.25}, {0.5, 0}, {0.25, 0.25}, {-0.25, 0.25}});
  const Corners box = box_corners(0.5, 0.25), capsule = capsule_corners({-0.5, 0}, {0.5, 0});
  for (const auto& [below, radius_a] :
       {std::pair(box, 0.0), std::pair(hexagon, 0.0), std::pair(capsule, 0.25)})
    for (const auto& [above, radius_b] :
         {std::pair(box, 0.0), std::pair(hexagon, 0.0), std::pair(capsule, 0.25)})
      for (const double overhang : {0.0, 0.2, -0.37})
        for (const double gap : {-0.003, 0.0005, 0.003})
          for (const double angle : {-2e-4, -1e-8, 0.0, 1e-8, 2e-4}) {
            const Solid<double> a(transformed(below, {{}, tilt}), radius_a), b(above, radius_b);
            Vec2d top{};
            for (const auto& corner : a.corners)
              if (dot(corner.normal, tilt * Vec2d{0, 1}) > dot(top, tilt * Vec2d{0, 1})) top = corner.normal;
            const Pose<double> pose{tilt * Vec2d{overhang, 0.5 + gap}, rotation_of(0.3 + angle)};
            const auto manifold = collide(a, b, pose);
            ASSERT_EQ(manifold.count, 2);
            EXPECT_EQ(manifold.normal, top) << overhang << ' ' << gap << ' ' << angle;
          }
}

// A box that tips up about its corner keeps that corner's name until it stands on it.
TEST(Names, TheCornerOfATippingBoxKeepsItsName) {
  const Solid<double> floor(box_corners(20, 0.5), 0);
  const auto tipped = [&](double angle) {
    const Vec2d corner = rotation_of(angle) * Vec2d{0.5, -0.5};
    return collide(floor, kBox, at(1 - corner.x, 0.499 - corner.y, angle));
  };
  const auto flat = features(tipped(0));
  ASSERT_EQ(flat.size(), 2u);
  std::set<int> pivot;
  for (double angle = -0.04; angle > -0.78; angle -= 0.05) {
    const auto now = tipped(angle);
    ASSERT_EQ(now.count, 1) << angle;
    EXPECT_NEAR(now.points[0].separation, -0.001, 1e-15);
    if (pivot.empty()) pivot = features(now);
    EXPECT_EQ(features(now), pivot);
    EXPECT_TRUE(flat.contains(*pivot.begin()));
  }
}

// A rounded square that rolls on a floor: the separation is the height of the lowest hull corner, smooth
// through every angle, and the normal is the floor's.
TEST(RoundedPolygons, RollSmoothly) {
  const Solid<double> floor(box_corners(20, 0.5), 0);
  for (double angle = 0; angle < 7; angle += 1e-3) {
    double lowest = 0;
    for (const auto& corner : kRounded.corners)
      lowest = std::min(lowest, (rotation_of(angle) * corner.point).y);
    const auto manifold = collide(floor, kRounded, at(0.1, 0.5 + 0.1 - lowest - 0.001, angle));
    ASSERT_GE(manifold.count, 1) << angle;
    EXPECT_NEAR(manifold.normal.y, 1, 3e-6);
    double deepest = manifold.points[0].separation;
    if (manifold.count == 2) deepest = std::min(deepest, manifold.points[1].separation);
    EXPECT_NEAR(deepest, -0.001, 1e-6);
  }
}

// Round a corner of another rounded square, in small steps: no step turns the normal by more than it moves.
TEST(RoundedPolygons, TurnRoundACornerWithoutAJump) {
  Vec2d last{};
  for (int i = 0; i <= 1000; ++i) {
    const double angle = -0.3 + i * 2.2e-3;  // of the way from corner to corner, beyond both faces' normals
    const Vec2d way = rotation_of(angle) * Vec2d{0.19, 0};
    const auto manifold = collide(kRounded, kRounded, at(0.8 + std::max(way.x, 0.0), 0.8 + way.y, 0));
    if (manifold.count == 0) continue;
    if (i > 0 && length_squared(last) > 0) {
      EXPECT_LT(std::sqrt(length_squared(manifold.normal - last)), 4e-3) << angle;
    }
    last = manifold.normal;
  }
  EXPECT_GT(length_squared(last), 0);
}

/// All pairs of shapes, and of shapes without extent, with everything in the same place or in line.
template <class Real>
void expect_finite_everywhere() {
  const std::vector<Solid<Real>> shapes = {
      {disc_corner({}), 0},
      {disc_corner({}), 0.5},
      {capsule_corners({-1, 0}, {1, 0}), 0},
      {capsule_corners({-1, 0}, {1, 0}), 0.5},
      {capsule_corners({0, 0}, {2, 0}), 0.1},
      {box_corners(1, 1), 0},
      {box_corners(1, 0.5), 0.25},
      {convex_hull(std::vector<Vec2d>{{-1, -1}, {1, -1}, {0, 1}}), 0},
      {convex_hull(std::vector<Vec2d>{{-1, 0}, {0, -1}, {1, 0}, {0.2, 1}, {-0.2, 1}}), 0.1},
  };
  for (const Solid<Real>& a : shapes)
    for (const Solid<Real>& b : shapes)
      for (const double x : {0.0, 1e-30, -1e-12, 1.0, 2.0, -2.0})
        for (const double y : {0.0, -1e-30, 1e-12, 1.0, -1.0})
          for (const double angle : {0.0, M_PI / 2, M_PI, 1e-9, 0.5}) {
            const auto manifold = collide(a, b, at<Real>(x, y, angle), 0.1);
            for (int i = 0; i < manifold.count; ++i) {
              EXPECT_TRUE(std::isfinite(manifold.points[i].separation));
              EXPECT_TRUE(std::isfinite(manifold.points[i].point.x) &&
                          std::isfinite(manifold.points[i].point.y));
              EXPECT_NEAR(length_squared(manifold.normal), Real(1), 5 * std::numeric_limits<Real>::epsilon());
            }
            // In the same place they touch, whatever they are.
            if (x == 0 && y == 0) {
              EXPECT_GE(manifold.count, 1);
            }
          }
}

TEST(Degenerate, AlwaysFinite) {
  expect_finite_everywhere<float>();
  expect_finite_everywhere<double>();
}

// Of an outline whose edges bend by less than a cosine in float shows, the points are those on either side of
// the centre of mass; where that lies beyond the nearest edge, the far one is some edges away.
template <class Real>
void expect_points_about_the_pivot(double bend) {
  std::vector<Vec2d> outline;
  for (const double x : {-3.0, -2.0, -1.0, 1.0, 2.0, 3.0}) outline.push_back({x, bend * (x * x - 1)});
  outline.push_back({0, 1});
  const Solid<Real> slab(convex_hull(outline), 0), floor(box_corners(10, 1), 0);
  for (const double tilt : {-2.5, -1.5, -0.5, 0.5, 1.5, 2.5}) {
    const Pose<Real> pose = at<Real>(0, 1 + 6 * bend, tilt * bend);
    for (const double pivot : {-2.5, -1.5, 0.0, 1.5, 2.5}) {
      for (const bool floor_first : {true, false}) {
        const Rotation<Real> back = pose.rotation.inverse();
        const Vec2<Real> at_pivot = Vec2d{pivot, 2}.as<Real>();
        const auto manifold = floor_first
                                  ? collide_convex(floor.view(), slab.view(), pose, Real(0.1), at_pivot)
                                  : collide_convex(slab.view(), floor.view(), {-(back * pose.position), back},
                                                   Real(0.1), back * (at_pivot - pose.position));
        ASSERT_EQ(manifold.count, 2);
        double x[2];
        for (int i = 0; i < 2; ++i) {
          const Vec2<Real> point = manifold.points[i].point;
          x[i] = static_cast<double>(floor_first ? point.x : (pose.position + pose.rotation * point).x);
        }
        EXPECT_LT(std::min(x[0], x[1]), pivot) << bend << " " << tilt << " " << pivot << " " << floor_first;
        EXPECT_GT(std::max(x[0], x[1]), pivot) << bend << " " << tilt << " " << pivot << " " << floor_first;
      }
    }
  }
}

// Coordinates count from the pivot: from an end of a floor of 400 m a float has steps of 15 um.
TEST(LongFloor, PointsAreAsExactAsOnAShortOne) {
  const auto points = [](auto real, double half_length, double x, double tilt, bool floor_first) {
    using Real = decltype(real);
    const Solid<Real> floor(box_corners(half_length, 1), 0), box(box_corners(0.15, 0.05), 0);
    const double low = 0.15 * std::sin(tilt) + 0.05 * std::cos(tilt);
    const Pose<Real> pose = at<Real>(x, 1 + low, tilt);
    const Rotation<Real> back = pose.rotation.inverse();
    const auto manifold =
        floor_first
            ? collide_convex(floor.view(), box.view(), pose, Real(0.02), pose.position)
            : collide_convex(box.view(), floor.view(), {-(back * pose.position), back}, Real(0.02), {});
    std::vector<double> out;
    for (int i = 0; i < manifold.count; ++i) {
      const Vec2<Real> point = manifold.points[i].point,
                       arm = floor_first ? point - pose.position : pose.rotation * point;
      out.push_back(static_cast<double>(arm.x)), out.push_back(static_cast<double>(arm.y));
    }
    return out;
  };
  for (const bool floor_first : {true, false}) {
    for (const double tilt : {0.0, 0.01, 0.3}) {
      const std::vector<double> exact = points(double{}, 2, 0, tilt, floor_first);
      const std::vector<double> found = points(float{}, 200, 0.25, tilt, floor_first);
      ASSERT_EQ(found.size(), exact.size()) << tilt;
      // In a tilted box's frame the height of so long a floor is rounded as coarsely as its corners.
      for (std::size_t i = 0; i < exact.size(); ++i)
        EXPECT_NEAR(found[i], exact[i], i % 2 == 1 && !floor_first && tilt > 0 ? 1.5e-5 : 4e-7)
            << tilt << " " << i;
    }
  }
}

TEST(Slender, BothSidesOfTheCentreOfMassAreHeld) {
  for (const double bend : {1e-4, 1e-3, 4e-3}) {
    expect_points_about_the_pivot<float>(bend);
    expect_points_about_the_pivot<double>(bend);
  }
}

// The way out of two equal boxes in the same place is a box long.
TEST(Degenerate, SamePlaceSeparatesByTheLeastWay) {
  expect_points(collide(kDisc, kDisc, at(0, 0)), {0, 1}, {{0, 0}}, -1);
  const Solid<double> flat(box_corners(2, 0.5), 0);
  const auto boxes = collide(flat, flat, at(0, 0));
  ASSERT_EQ(boxes.count, 2);
  EXPECT_EQ(std::fabs(boxes.normal.y), 1);
  EXPECT_NEAR(boxes.points[0].separation, -1, 1e-15);
  const auto capsules = collide(kCapsule, kCapsule, at(0, 0));
  ASSERT_EQ(capsules.count, 2);
  EXPECT_EQ(std::fabs(capsules.normal.y), 1);
  EXPECT_NEAR(capsules.points[0].separation, -0.5, 1e-15);
}

// Shapes of a compound a kilometre from its body's origin: what a float's digits there leave, 6e-5 m, is a
// common shift; the two points agree with each other to a shape's own digits.
TEST(Precision, FarFromTheBodysOrigin) {
  const Solid<float> box(box_corners(0.5, 0.5, {1000, 1000}), 0), other(box_corners(0.5, 0.5), 0);
  const auto manifold = collide(box, other, at<float>(1000.2, 1000.99));
  ASSERT_EQ(manifold.count, 2);
  EXPECT_NEAR(manifold.points[0].separation, -0.01, 6.2e-5);
  EXPECT_NEAR(manifold.points[0].separation, manifold.points[1].separation, 1.2e-7);
  const Solid<float> wedge(
      convex_hull(std::vector<Vec2d>{{999, 999}, {1001, 999}, {1000.5, 1000.5}, {999.5, 1000.5}}), 0);
  const auto second = collide(wedge, other, at<float>(1000, 1000.99));
  ASSERT_EQ(second.count, 2);
  EXPECT_NEAR(second.points[0].separation, second.points[1].separation, 1.2e-7);
}

}  // namespace
}  // namespace plumb
