#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <vector>

#include "engine/geometry/convex_bounds.h"
#include "engine/geometry/convex_hull.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "tests/world/passages.h"
#include "tests/world/support.h"

// Slender polygons: many of their edges are nearly parallel, and they are thin.
namespace plumb {
namespace {

using passages::Draw;

template <class Real>
class Needles : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Needles, Reals);

/// Three to eight corners near a line: on a slim ellipse, in a strip, or in one with two sharp ends. Its
/// thickness is at least a thousandth of its length.
Corners any_needle(Draw& draw, double size) {
  while (true) {
    const double thickness = draw.spread(0.001, 0.1), turn = draw.even(0, 2 * std::numbers::pi),
                 aside = draw.even(-1, 1);
    const int count = 3 + draw.choose(6), kind = draw.choose(3);
    std::vector<Vec2d> points;
    for (int i = 0; i < count; ++i) {
      const double around = draw.even(0, 2 * std::numbers::pi);
      Vec2d point{draw.even(-0.5, 0.5), draw.even(-0.5, 0.5) * thickness};
      if (kind == 0) point = {0.5 * std::cos(around), 0.5 * thickness * std::sin(around)};
      if (kind == 1 && i < 2) point = {i - 0.5, 0};
      points.push_back(size * (rotation_of(turn) * (point + Vec2d{aside, 0})));
    }
    try {
      const Corners corners = convex_hull(points);
      const Convex<double> needle{corners.data(), static_cast<int>(corners.size()), 0};
      if (convex_half_width(needle) > 0.0005 * size && convex_extent(needle, corners[0].point) > 0.5 * size)
        return corners;
    } catch (const Error&) {  // its points are in a line
    }
  }
}

template <class Real>
void add_floor(BasicWorld<Real>& world, int kind, double size) {
  const auto fixed = [&](ShapeGeometry geometry, Vec2d position) {
    world.create_body({.type = BodyType::Static, .position = position}, {.geometry = geometry});
  };
  switch (kind) {
    case 0:
      return fixed(Box{400 * size, 2 * size}, {0, -size});
    case 1:
      return fixed(Segment{{-100 * size, 0}, {100 * size, 0}}, {0, 0});
    case 2: {
      std::vector<Vec2d> points;
      for (int i = 100; i >= -100; --i) points.push_back({0.37 * i * size, 0});
      world.create_chain(world.create_body({.type = BodyType::Static}), {.points = points});
      return;
    }
    case 3:
      return fixed(
          Polygon{{{-30 * size, -size}, {0, -2 * size}, {30 * size, -size}, {30 * size, 0}, {-30 * size, 0}}},
          {0, 0});
    default:
      for (int i = -50; i <= 50; ++i) fixed(Box{0.5 * size, 2 * size}, {0.5 * i * size, -size});
  }
}

// A contact's spring sinks by some tenths of g h^2 (h the substep) under a body's weight. Five or six of
// these 4,000 needles rock for ever between a corner and a seam, or stand on one.
TYPED_TEST(Needles, LieOnAnyFloorAndSleep) {
  int wrong = 0;
  std::ostringstream said;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    Draw draw(seed);
    const double size = draw.spread(0.1, 10);
    const Corners corners = any_needle(draw, size);
    Polygon needle;
    for (const Corner<double>& corner : corners) needle.points.push_back(corner.point);
    const int floor = draw.choose(5);
    const bool floor_first = draw.chance(0.5);
    BasicWorld<TypeParam> world;
    if (floor_first) add_floor(world, floor, size);
    const BodyId body = world.create_body({.position = {0, draw.even(2.5, 5) * size},
                                           .angle = draw.even(-4, 4),
                                           .angular_velocity = draw.chance(0.5) ? draw.even(-10, 10) : 0},
                                          {.geometry = needle});
    if (!floor_first) add_floor(world, floor, size);
    for (int i = 0; i < 1200 && world.awake(body); ++i) world.step();
    double lowest = std::numeric_limits<double>::max(), highest = -lowest;
    for (const Vec2d point : needle.points) {
      lowest = std::min(lowest, world.world_point(body, point).y);
      highest = std::max(highest, world.world_point(body, point).y);
    }
    const double substep = 1.0 / 240;
    if (world.awake(body) || !(lowest > -9.81 * substep * substep) || !(lowest < 0.001 * size) ||
        !(highest < 0.11 * size))
      ++wrong, said << "seed " << seed << ": " << corners.size() << " corners, " << size << " m, floor "
                    << floor << ": between " << lowest << " and " << highest << " m, turns at "
                    << world.angular_velocity(body) << " rad/s\n";
  }
  EXPECT_LE(wrong, 6) << said.str();
}

// Down a slope of 0.5 rad with friction 0.1 a body slides by a t^2 / 2, a = g (sin - mu cos), from rest or
// after a fall onto it. The core of a slender body lies nearer to the slope than a fast body used to stop
// before an obstacle, so those that slid stood still for steps, with the velocity that they had.
TYPED_TEST(Needles, SlideDownASlopeAsFarAsTheyShould) {
  const double slope = 0.5, friction = 0.1, gravity = 10, time = 1.5;
  const Vec2d along{-std::cos(slope), -std::sin(slope)}, up{-std::sin(slope), std::cos(slope)};
  const double expected = 0.5 * gravity * (std::sin(slope) - friction * std::cos(slope)) * time * time;
  for (const bool triangle : {false, true}) {
    for (const double thickness : {0.001, 0.003, 0.01, 0.05}) {
      for (const double tilt : {0.0, 0.001, 0.01, 0.1, 0.5}) {
        for (const double drop : {0.0, 0.5}) {
          BasicWorld<TypeParam> world({.gravity = {0, -gravity}, .sleeping = false});
          const double length = 1.28;
          world.create_body({.type = BodyType::Static, .position = -1.0 * up, .angle = slope},
                            ShapeDefinition{.geometry = Box{400, 2}, .material = {friction, 0}});
          const Polygon shard{
              {{-0.5 * length, -0.5 * thickness}, {0, 0.5 * thickness}, {0.5 * length, -0.5 * thickness}}};
          const ShapeGeometry geometry =
              triangle ? ShapeGeometry(shard) : ShapeGeometry(Box{length, thickness});
          const double height = 0.5 * thickness + drop + 0.5 * length * std::sin(tilt);
          const BodyId body =
              world.create_body({.position = height * up, .angle = slope + tilt},
                                ShapeDefinition{.geometry = geometry, .material = {friction, 0}});
          run(world, 90);
          // A blow on an end turns some of the fall into sliding, and friction in it takes some away.
          EXPECT_NEAR(dot(world.position(body), along), expected, 0.05 * expected)
              << (triangle ? "triangle" : "box") << ", thickness " << thickness << " m, tilt " << tilt
              << " rad, drop " << drop << " m";
        }
      }
    }
  }
}

// The very needle, in four corners that bend by less than half a milliradian.
TYPED_TEST(Needles, OneOfAHairsThicknessLies) {
  BasicWorld<TypeParam> world;
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{400, 2}});
  const Polygon needle{{{-0.308712091, -0.224183794},
                        {-0.203785165, -0.14805131},
                        {0.221524596, 0.160945908},
                        {0.266209764, 0.193486818}}};
  const BodyId body = world.create_body({.position = {0, 0.572}}, {.geometry = needle});
  run(world, 300);
  EXPECT_FALSE(world.awake(body));
  for (const Vec2d point : needle.points) EXPECT_NEAR(world.world_point(body, point).y, 0, 1e-4);
}

}  // namespace
}  // namespace plumb
