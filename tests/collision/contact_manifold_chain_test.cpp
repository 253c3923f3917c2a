#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/collision/convex_truth.h"

namespace plumb {
namespace {

using truth::Dice;
using truth::Solid;

/// A chain in the order of its vertices; its front is to the right. The first and last vertex are only
/// neighbours.
template <class Real>
struct Chain {
  std::vector<Vec2<Real>> vertices;
  double radius = 0;

  int segments() const { return static_cast<int>(vertices.size()) - 3; }

  ContactManifold<Real> collide(int i, const Solid<Real>& b, const Pose<Real>& pose, double reach) const {
    const Solid<Real> segment(
        capsule_corners(vertices[i + 1].template as<double>(), vertices[i + 2].template as<double>()),
        radius);
    return collide_chain_segment(segment.view(), vertices[i], vertices[i + 3], b.view(), pose,
                                 static_cast<Real>(reach), pose.position);
  }
};

template <class Real>
Pose<Real> pose_at(Vec2d position, double angle) {
  const Rotation<double> q = rotation_of(angle);
  return {position.as<Real>(), {static_cast<Real>(q.c), static_cast<Real>(q.s)}};
}

/// A straight floor of many segments of unequal length, tilted by `angle`: its front is up.
template <class Real>
Chain<Real> straight_floor(Dice& dice, double angle, int count) {
  Chain<Real> chain;
  const Rotation<double> q = rotation_of(angle);
  double x = 0.5 * count;
  for (int i = 0; i < count + 3; ++i, x -= dice.number(0.3, 1.7))
    chain.vertices.push_back((q * Vec2d{x, 0}).as<Real>());
  return chain;
}

/// Slides `b` over a floor in leaps of any length, into it and over it, and expects its normal everywhere.
template <class Real>
void expect_smooth(Dice& dice, const Corners& corners, double radius, double normal_error) {
  const double tilt = dice.number(-3, 3);
  const Chain<Real> floor = straight_floor<Real>(dice, tilt, 1000);
  const Rotation<double> q = rotation_of(tilt);
  const Vec2d up = q * Vec2d{0, 1};
  const Solid<Real> b(corners, radius);
  for (int step = 0; step < 150; ++step) {
    const double turn = step % 3 == 0 ? dice.number(-4, 4) : (step % 3 == 1 ? 0 : dice.number(-2e-3, 2e-3));
    double lowest = std::numeric_limits<double>::infinity();
    for (const Corner<double>& corner : corners)
      lowest = std::min(lowest, (rotation_of(turn) * corner.point).y - radius);
    const double separation = step % 2 ? dice.number(-0.1, -0.001) : dice.number(-0.001, 0.015);
    const Vec2d at{dice.number(-400, 400), separation - lowest};
    const Pose<Real> pose = pose_at<Real>(q * at, tilt + turn);

    double deepest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < floor.segments(); ++i) {
      const auto manifold = floor.collide(i, b, pose, 0.02);
      for (int k = 0; k < manifold.count; ++k) {
        EXPECT_NEAR(cross(manifold.normal.template as<double>(), up), 0, normal_error);
        EXPECT_GT(dot(manifold.normal.template as<double>(), up), 0);
        deepest = std::min(deepest, static_cast<double>(manifold.points[k].separation));
      }
    }
    // Some segment has it, at its depth. Coordinates of hundreds round by this much.
    const double rounding = 500 * double{std::numeric_limits<Real>::epsilon()};
    EXPECT_NEAR(deepest, separation, 2 * rounding) << step;
  }
}

template <class Real>
void expect_all_smooth(double normal_error) {
  Dice dice(11);
  for (int trial = 0; trial < 3; ++trial) {
    expect_smooth<Real>(dice, disc_corner({0.1, 0.2}), 0.5, normal_error);
    expect_smooth<Real>(dice, box_corners(0.5, 0.25), 0, normal_error);
    expect_smooth<Real>(dice, box_corners(2.5, 0.5), 0.1, normal_error);
    expect_smooth<Real>(dice, capsule_corners({-0.5, 0}, {0.5, 0}), 0.3, normal_error);
    expect_smooth<Real>(dice, dice.corners(Dice::Polygon, 1), 0.05, normal_error);
  }
}

// The error of the normal is that of the vertices' rounding: 500 m of a float's digits over the shortest
// segment, 0.3 m. What is parallel may take the shape's own normal instead (kParallel), which admits 2e-3.
TEST(ChainSegment, SlidingOverSeamsMeetsTheSurfacesNormalOnly) {
  expect_all_smooth<float>(4e-4);
  expect_all_smooth<double>(1e-12);
}

// The lowest corner stands on a vertex, give or take some digits: one of the two segments must hold it.
TEST(ChainSegment, NothingFallsBetweenTwoSegments) {
  Dice dice(14);
  for (const double tilt : {0.0, 0.3, -1.1}) {
    const Chain<float> floor = straight_floor<float>(dice, tilt, 300);
    const Rotation<double> q = rotation_of(tilt);
    const Vec2d along = q * Vec2d{1, 0}, up = q * Vec2d{0, 1};
    const double turn = 0.6;
    const Vec2d low =
        rotation_of(tilt + turn) * Vec2d{-0.5, -0.5};  // of a box turned by less than a quarter turn
    const Vec2d corner{-0.5, -0.5}, upright = rotation_of(-turn) * Vec2d{0, 1};
    const Solid<float> box(box_corners(0.5, 0.5), 0), disc(disc_corner(corner), 0.01),
        pole(capsule_corners(corner, corner + upright), 0);
    for (const Solid<float>& b : {box, disc, pole})
      for (int i = 1; i < floor.segments(); ++i) {
        const double height = b.radius > 0 ? 0.004 : -0.004;  // a disc's centre has to be in front
        for (int step = -20; step <= 20; ++step) {
          const Vec2d at = floor.vertices[i + 1].as<double>() - low + height * up + (step * 2e-6) * along;
          const Pose<float> pose = pose_at<float>(at, tilt + turn);
          const auto left = floor.collide(i - 1, b, pose, 0.02), right = floor.collide(i, b, pose, 0.02);
          EXPECT_GT(left.count + right.count, 0) << i << ' ' << step;
        }
      }
  }
}

// A smooth end reaches some roundings farther than its vertex, and no more than that.
TEST(ChainSegment, SmoothEndsOverlapByRoundings) {
  const Chain<float> floor{{{3, 0}, {1, 0}, {-1, 0}, {-3, 0}}};
  const Solid<float> pole(capsule_corners({0, 0}, {0, 1}), 0);
  for (const float side : {-1.0f, 1.0f}) {
    EXPECT_EQ(floor.collide(0, pole, {{side * 1.000001f, -0.01f}, {}}, 0.02).count, 1);
    EXPECT_EQ(floor.collide(0, pole, {{side * 1.0001f, -0.01f}, {}}, 0.02).count, 0);
  }
}

// Truth for a disc on a chain: the nearest point of the whole chain.
TEST(ChainSegment, DiscRollsOverBendsWithTheDistanceToTheChain) {
  Dice dice(12);
  for (int trial = 0; trial < 50; ++trial) {
    Chain<double> chain;
    double x = 6;
    for (int i = 0; i < 13; ++i, x -= dice.number(0.5, 1.5))
      chain.vertices.push_back({x, dice.number(-0.3, 0.3)});
    const Solid<double> disc(disc_corner({}), 0.4);
    for (int k = 0; k < 200; ++k) {
      const Vec2d center{dice.number(-2.5, 3), dice.number(-0.2, 0.8)};
      double least = std::numeric_limits<double>::infinity();
      Vec2d foot{};
      bool in_front = false;
      for (int i = 0; i + 1 < 13; ++i) {
        const Vec2d u = chain.vertices[i], way = chain.vertices[i + 1] - u;
        const double share = std::clamp(dot(center - u, way) / length_squared(way), 0.0, 1.0);
        const Vec2d offset = center - u - share * way;
        if (const double distance = std::sqrt(length_squared(offset)); distance < least)
          least = distance, foot = center - offset;
        if (center.x <= u.x && center.x >= chain.vertices[i + 1].x) in_front = cross(way, center - u) < 0;
      }
      double deepest = std::numeric_limits<double>::infinity();
      Vec2d normal{};
      for (int i = 0; i < chain.segments(); ++i) {
        const auto manifold = chain.collide(i, disc, pose_at<double>(center, 0), 0.05);
        if (manifold.count > 0 && manifold.points[0].separation < deepest)
          deepest = manifold.points[0].separation, normal = manifold.normal;
      }
      if (!in_front || least > 0.45) {
        EXPECT_EQ(deepest, std::numeric_limits<double>::infinity());
        continue;
      }
      EXPECT_NEAR(deepest, least - 0.4, 1e-14);
      EXPECT_NEAR(cross(normal, center - foot), 0, 1e-14);
    }
  }
}

/// Floor from x = 10 to x = 0 at y = 0, then a wall up: both fronts look at the room above and to the right.
const std::vector<Vec2d> kRoom = {{20, 0}, {10, 0}, {0, 0}, {0, 10}, {0, 20}};
/// A table from x = 0 to x = -10 at y = 0, whose sides go down at both ends.
const std::vector<Vec2d> kTable = {{0, -10}, {0, 0}, {-10, 0}, {-10, -10}};

TEST(ChainSegment, InAHollowCornerEachSideHoldsWithItsOwnNormal) {
  const Chain<double> room{kRoom};
  for (const Solid<double>& b : {Solid<double>(disc_corner({}), 0.5), Solid<double>(box_corners(0.5, 0.5), 0),
                                 Solid<double>(box_corners(0.4, 0.4), 0.1)}) {
    const Pose<double> pose = pose_at<double>({0.49, 0.48}, 0);
    const auto floor = room.collide(0, b, pose, 0.02), wall = room.collide(1, b, pose, 0.02);
    ASSERT_GT(floor.count, 0);
    ASSERT_GT(wall.count, 0);
    EXPECT_EQ(floor.normal, (Vec2d{0, 1}));
    EXPECT_EQ(wall.normal, (Vec2d{1, 0}));
    EXPECT_NEAR(floor.points[0].separation, -0.02, 1e-15);
    EXPECT_NEAR(wall.points[0].separation, -0.01, 1e-15);
  }
}

TEST(ChainSegment, BoxOverAnEdgeTipsAboutIt) {
  const Chain<double> table{kTable};
  // Half over the edge: the edge and the far corner hold it.
  const Solid<double> box(box_corners(0.5, 0.5), 0);
  const auto flat = table.collide(0, box, pose_at<double>({-0.1, 0.499}, 0), 0.02);
  ASSERT_EQ(flat.count, 2);
  EXPECT_EQ(flat.normal, (Vec2d{0, 1}));
  EXPECT_NEAR(std::max(flat.points[0].point.x, flat.points[1].point.x), 0, 1e-15);
  EXPECT_NEAR(std::min(flat.points[0].point.x, flat.points[1].point.x), -0.6, 1e-15);
  // Tilted about the edge: its lower face gives the normal, between the table's and the side's.
  const auto tilted =
      table.collide(0, box, pose_at<double>(rotation_of(-0.5) * Vec2d{0.1, 0.499}, -0.5), 0.02);
  ASSERT_GE(tilted.count, 1);
  EXPECT_NEAR(tilted.normal.x, std::sin(0.5), 1e-15);
  EXPECT_NEAR(tilted.normal.y, std::cos(0.5), 1e-15);
  EXPECT_NEAR(tilted.points[0].separation, -0.001, 1e-15);
}

// A box that slides down along the side goes into it by a hair: the table must not lift it. Its own side is
// all that the table's end may offer, and not even that once it looks down: then it is the side's.
TEST(ChainSegment, WhatTouchesTheNeighbourIsLeftToIt) {
  const Chain<double> table{kTable};
  const Solid<double> box(box_corners(0.5, 0.5), 0);
  for (const double angle : {0.0, 0.05, -0.05})
    for (const double depth : {1e-4, 1e-3, 1e-2}) {
      // The side of the box at the table's height lies `depth` beyond the edge.
      const double x = (0.5 + 0.2 * std::sin(angle)) / std::cos(angle) - depth;
      const auto manifold = table.collide(0, box, pose_at<double>({x, 0.2}, angle), 0.02);
      EXPECT_EQ(manifold.count > 0, angle >= 0);
      for (int k = 0; k < manifold.count; ++k) {
        EXPECT_GT(manifold.points[k].separation, -0.05);
        EXPECT_NEAR(manifold.normal.y, std::sin(angle), 1e-15);
      }
    }
}

// A wedge that has sunk in by more than half still goes back to the front.
TEST(ChainSegment, WhatHasSunkDeepComesOutInFront) {
  const Chain<double> table{kTable};
  const Solid<double> wedge(convex_hull(std::vector<Vec2d>{{0, -0.6}, {3, 0.4}, {-3, 0.4}}), 0);
  const auto manifold = table.collide(0, wedge, pose_at<double>({-5, 0.05}, 0), 0.02);
  ASSERT_GT(manifold.count, 0);
  EXPECT_EQ(manifold.normal, (Vec2d{0, 1}));
  EXPECT_NEAR(std::min(manifold.points[0].separation, manifold.points[manifold.count - 1].separation), -0.55,
              1e-15);
}

TEST(ChainSegment, HasNoBack) {
  const Chain<double> table{kTable};
  for (const Solid<double>& b : {Solid<double>(disc_corner({}), 0.5), Solid<double>(box_corners(0.5, 0.5), 0),
                                 Solid<double>(capsule_corners({-0.5, 0}, {0.5, 0}), 0.2)})
    for (const double y : {-0.01, -0.2, -0.45})
      EXPECT_EQ(table.collide(0, b, pose_at<double>({-5, y}, 0.3), 0.02).count, 0);
}

// A neighbour that is the same point is none: the end is a corner like any other.
TEST(ChainSegment, OpenEndsAreRound) {
  const Chain<double> plank{{{0, 0}, {0, 0}, {-10, 0}, {-10, 0}}};
  const Vec2d out{std::sqrt(0.5), std::sqrt(0.5)};
  const Solid<double> disc(disc_corner({}), 0.5), box(box_corners(0.5, 0.5), 0);
  const auto of_disc = plank.collide(0, disc, pose_at<double>(0.49 * out, 0), 0.02);
  ASSERT_EQ(of_disc.count, 1);
  EXPECT_NEAR(cross(of_disc.normal, out), 0, 1e-15);
  EXPECT_NEAR(of_disc.points[0].separation, -0.01, 1e-15);
  const auto of_box = plank.collide(0, box, pose_at<double>(0.49 * out, M_PI / 4), 0.02);
  ASSERT_GE(of_box.count, 1);
  EXPECT_NEAR(cross(of_box.normal, out), 0, 1e-15);
  EXPECT_NEAR(of_box.points[0].separation, -0.01, 1e-15);
}

TEST(ChainSegment, RadiusOfTheChainCounts) {
  Chain<double> table{kTable};
  table.radius = 0.25;
  const auto manifold =
      table.collide(0, Solid<double>(box_corners(0.5, 0.5), 0), pose_at<double>({-5, 0.76}, 0), 0.1);
  ASSERT_EQ(manifold.count, 2);
  EXPECT_NEAR(manifold.points[0].separation, 0.01, 1e-15);
  EXPECT_NEAR(manifold.points[0].point.y, 0.255, 1e-15);
}

// Fine curves of many short segments: a wide box lies on the top as on a smooth hill.
TEST(ChainSegment, AFineHillIsSmooth) {
  Chain<float> hill;
  const double step = 0.005;  // rad; the hill's radius is 10 m
  for (int i = -100; i <= 100; ++i)
    hill.vertices.push_back(Vec2d{-10 * std::sin(step * i), 10 * std::cos(step * i)}.as<float>());
  const Solid<float> box(box_corners(0.3, 0.3), 0), disc(disc_corner({}), 0.3);
  Dice dice(13);
  for (int trial = 0; trial < 200; ++trial) {
    const double angle = dice.number(-0.35, 0.35);
    const Vec2d up{-std::sin(angle), std::cos(angle)};
    for (const Solid<float>* b : {&box, &disc}) {
      double deepest = 1;
      for (int i = 0; i < hill.segments(); ++i) {
        const auto manifold = hill.collide(i, *b, pose_at<float>(10.299 * up, angle), 0.005);
        for (int k = 0; k < manifold.count; ++k) {
          // Within the box's own reach the hill turns by 0.03 rad.
          EXPECT_LT(std::fabs(cross(manifold.normal.as<double>(), up)), 0.04);
          deepest = std::min(deepest, static_cast<double>(manifold.points[k].separation));
        }
      }
      EXPECT_NEAR(deepest, -0.001, 1.3e-4);  // the chords' own height, 10 step^2 / 8, and a float's digits
    }
  }
}

}  // namespace
}  // namespace plumb
