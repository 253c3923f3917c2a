#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <vector>

#include "engine/precise/precise.h"
#include "engine/world/queries.h"
#include "tests/world/passages.h"
#include "tests/world/support.h"

// Polygons with corners that hardly stand out, and with edges that are hardly long.
namespace plumb {
namespace {

using passages::Draw;

template <class Real>
class NearFlatCorners : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(NearFlatCorners, Reals);

Vec2d rotated(Vec2d p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

/// A box with up to three more corners on each side, on an arc that stands out by `rise`.
std::vector<Vec2d> bent_box(Draw& draw, double width, double height, double rise) {
  const Vec2d corners[] = {
      {-width / 2, -height / 2}, {width / 2, -height / 2}, {width / 2, height / 2}, {-width / 2, height / 2}};
  std::vector<Vec2d> points;
  for (int i = 0; i < 4; ++i) {
    const Vec2d from = corners[i], edge = corners[(i + 1) % 4] - from;
    const Vec2d out = (1 / std::sqrt(length_squared(edge))) * -perpendicular(edge);
    points.push_back(from);
    for (int k = draw.choose(4); k > 0; --k) {
      const double part = draw.even(0.02, 0.98);
      points.push_back(from + part * edge + (4 * part * (1 - part) * rise) * out);
    }
  }
  return points;
}

std::vector<Vec2d> lens(double length, double thickness, int count) {
  std::vector<Vec2d> points;
  for (int i = 0; i < count; ++i) {
    const double around = 2 * std::numbers::pi * (i + 0.3 * std::sin(i)) / count;
    points.push_back({length / 2 * std::cos(around), thickness / 2 * std::sin(around)});
  }
  return points;
}

// Sixty-four corners on a lens of 1 : 500 stand out by 1e-9 to 5e-6 of its length.
TYPED_TEST(NearFlatCorners, AreKeptIfTheNumbersHoldThem) {
  for (const double thickness : {1.0, 0.05, 0.002}) {
    const Polygon polygon{lens(1, thickness, 64)};
    const QueryShape query(polygon);
    EXPECT_EQ(query.convex().count, 64);
    DoubleWorld world;
    const BodyId body = world.create_body({}, {.geometry = polygon});
    EXPECT_EQ(std::get<Polygon>(world.definition(world.shapes(body)[0]).geometry).points.size(), 64u);
  }
  const double least = std::is_same_v<TypeParam, float> ? 2e-6 : 4e-15;
  for (const double size : {0.01, 1.0, 100.0}) {
    BasicWorld<TypeParam> world;
    const BodyId body = world.create_body(
        {}, {.geometry = Polygon{{{-size, 0}, {0, -least * size}, {size, 0}, {size, size}, {-size, size}}}});
    EXPECT_EQ(std::get<Polygon>(world.definition(world.shapes(body)[0]).geometry).points.size(), 5u);
  }
}

// Dropping corners moves the outline by a few roundings at most.
TYPED_TEST(NearFlatCorners, AreDroppedOnlyWithinTheRounding) {
  const double rounding = 10 * static_cast<double>(std::numeric_limits<TypeParam>::epsilon());
  Draw draw(1);
  for (int i = 0; i < 2000; ++i) {
    const Polygon polygon{bent_box(draw, 1, 0.5, draw.spread(1e-17, 1e-3))};
    BasicWorld<TypeParam> world;
    const BodyId body = world.create_body({.type = BodyType::Static}, {.geometry = polygon});
    for (const Vec2d point : polygon.points) {
      const auto at = nearest(world, point, 1);
      ASSERT_TRUE(at);
      EXPECT_LT(std::fabs(at->distance), rounding) << i;
    }
    EXPECT_EQ(world.shapes(body).size(), 1u);
  }
}

TYPED_TEST(NearFlatCorners, CarryABody) {
  for (const double rise : {9e-4, 1e-4}) {
    BasicWorld<TypeParam> world;
    world.create_body({.type = BodyType::Static, .position = {0, -50}}, {.geometry = Box{2000, 100}});
    const BodyId body = world.create_body({.position = {0, 1}, .lock_rotation = true},
                                          {.geometry = Polygon{{{-50, 0}, {0, -rise}, {50, 0}, {0, 20}}}});
    run(world, 300);
    const double sinks = 9.81 / (240.0 * 240.0);  // by some tenths of g h^2, h the substep
    EXPECT_NEAR(world.position(body).y, rise, 0.5 * sinks);
  }
}

TEST(NearFlatCornersInDouble, CarryABodyUnderPrecise) {
  for (const double rise : {9e-4, 1e-4, 2e-6}) {
    Scene scene{.name = "lens"};
    Body ground{.name = "ground", .type = BodyType::Static, .position = {0, -50}};
    ground.shapes = {{.geometry = Box{2000, 100}}};
    Body body{.name = "body", .position = {0, 1}};
    body.fixed_rotation = true;
    body.shapes = {{.geometry = Polygon{{{-50, 0}, {0, -rise}, {50, 0}, {0, 20}}}}};
    scene.bodies = {ground, body};
    const auto driver = make_precise_driver(scene, Precise{}, {});
    for (int i = 0; i < 120; ++i) driver->step();
    std::vector<BodyState> states(2);
    driver->read(states);
    EXPECT_NEAR(states[1].position.y, rise, 1e-12);
  }
}

// A body that lands on corners that stand out by little more than the gaps that count as closed would rock on
// them without end.
TEST(NearFlatCornersInDouble, LetABodyLandUnderPrecise) {
  for (int seed = 0; seed < 150; ++seed) {
    Draw draw(static_cast<std::uint64_t>(seed));
    const double rise = draw.spread(1e-15, 1e-4);
    Polygon polygon{bent_box(draw, 1, 0.3, rise)};
    Scene scene{.name = "landing"};
    Body ground{.name = "ground", .type = BodyType::Static, .position = {0, -5}};
    ground.shapes = {{.geometry = Box{200, 10}}};
    Body body{.name = "body", .position = {0, 0.5}};
    body.angle = draw.chance(0.5) ? draw.even(-0.3, 0.3) : 0;
    body.shapes = {{.geometry = polygon, .friction = 0.5}};
    scene.bodies = {ground, body};
    const auto driver = make_precise_driver(scene, Precise{}, {});
    std::vector<BodyState> states(2);
    ASSERT_NO_THROW(for (int i = 0; i < 120; ++i) driver->step()) << "seed " << seed;
    driver->read(states);
    double lowest = 1;
    for (const Vec2d point : polygon.points)
      lowest = std::min(lowest, states[1].position.y + rotated(point, states[1].angle).y);
    EXPECT_NEAR(lowest, 0, 2e-7) << "seed " << seed << ": less than 1e-9 of 100 m";
  }
}

template <class Real>
void add_floor(BasicWorld<Real>& world, int kind, double size, double rise) {
  const auto fixed = [&](ShapeGeometry geometry, Vec2d position) {
    world.create_body({.type = BodyType::Static, .position = position}, {.geometry = geometry});
  };
  if (kind == 0) return fixed(Box{400 * size, 2 * size}, {0, -size});
  if (kind == 1) return fixed(Segment{{-100 * size, 0}, {100 * size, 0}}, {0, 0});
  if (kind == 2) {
    std::vector<Vec2d> points;
    for (int i = 100; i >= -100; --i) points.push_back({0.37 * i * size, 0});
    world.create_chain(world.create_body({.type = BodyType::Static}), {.points = points});
  } else if (kind == 3) {  // the floor's corners hardly stand out either
    Polygon floor{{{-30 * size, -size}, {0, -2 * size}, {30 * size, -size}}};
    for (int i = 0; i <= 20; ++i) {
      const double x = 0.1 * i - 1;
      floor.points.push_back({30 * size * x, -rise * x * x});
    }
    fixed(floor, {0, 0});
  } else {
    for (int i = -50; i <= 50; ++i) fixed(Box{0.5 * size, 2 * size}, {0.5 * i * size, -size});
  }
}

// As few as of plain boxes, of which 4 of these 800 do not sleep within 20 s, in float and in double.
TYPED_TEST(NearFlatCorners, LieOnAnyFloorAndSleep) {
  int wrong = 0;
  std::ostringstream said;
  for (int seed = 0; seed < 800; ++seed) {
    Draw draw(static_cast<std::uint64_t>(seed));
    const double size = draw.spread(0.1, 10), rise = size * draw.spread(1e-16, 1e-4);
    const Polygon polygon{bent_box(draw, size, size * draw.spread(0.05, 1), rise)};
    const int floor = draw.choose(5);
    BasicWorld<TypeParam> world;
    add_floor(world, floor, size, rise);
    const BodyId body = world.create_body({.position = {0, draw.even(1, 2) * size},
                                           .angle = draw.chance(0.5) ? 0 : draw.even(-4, 4),
                                           .angular_velocity = draw.chance(0.5) ? draw.even(-5, 5) : 0},
                                          {.geometry = polygon});
    for (int i = 0; i < 1200 && world.awake(body); ++i) world.step();
    double lowest = std::numeric_limits<double>::max();
    for (const Vec2d point : polygon.points) lowest = std::min(lowest, world.world_point(body, point).y);
    const double sinks = 9.81 / (240.0 * 240.0) + 2 * rise;
    if (world.awake(body) || !(lowest > -sinks) || !(lowest < 0.001 * size + 2 * rise))
      ++wrong, said << "seed " << seed << ": floor " << floor << ", " << size << " m, rise " << rise
                    << " m, at " << lowest << " m" << (world.awake(body) ? ", awake\n" : "\n");
  }
  EXPECT_LE(wrong, 6) << said.str();
}

TYPED_TEST(NearFlatCorners, SlideOverSeams) {
  for (int seed = 0; seed < 300; ++seed) {
    Draw draw(static_cast<std::uint64_t>(seed));
    const double size = draw.spread(0.3, 3), rise = size * draw.spread(1e-16, 1e-5);
    const double tile = draw.spread(0.1, 3) * size, speed = draw.even(1, 10);
    const Polygon polygon{bent_box(draw, size, size * draw.spread(0.2, 1), rise)};
    double low = 0;
    for (const Vec2d point : polygon.points) low = std::min(low, point.y);
    BasicWorld<TypeParam> world({.sleeping = false});
    const int kind = draw.choose(3);
    for (double x = -4 * size; x < 2 * speed + 4 * size + tile; x += tile) {
      ShapeGeometry geometry = Segment{{-tile / 2, 0}, {tile / 2, 0}};
      if (kind == 1) geometry = Polygon{{{-tile / 2, -1}, {tile / 2, -1}, {-tile / 2, 0}, {tile / 2, 0}}};
      if (kind == 2) {
        Polygon bent{{{-tile / 2, -1}, {tile / 2, -1}}};
        for (int k = -3; k <= 3; ++k) bent.points.push_back({k / 6.0 * tile, rise * (1 - k * k / 9.0)});
        geometry = bent;
      }
      world.create_body({.type = BodyType::Static, .position = {x, 0}},
                        {.geometry = geometry, .material = {.friction = 0}});
    }
    const BodyId body = world.create_body({.position = {0, -low}, .velocity = {speed, 0}},
                                          {.geometry = polygon, .material = {.friction = 0}});
    for (int i = 0; i < 120; ++i) {
      world.step();
      ASSERT_NEAR(world.velocity(body).x / speed, 1, 1e-3) << "seed " << seed;
      ASSERT_NEAR(world.position(body).y, -low, 2e-3 * std::max(size, 1.0)) << "seed " << seed;
      ASSERT_NEAR(world.angle(body), 0, 5e-3) << "seed " << seed;
    }
  }
}

// The corners of an edge of 1e-13 m, seen from 1e6 m, lie on each other: its direction comes from the shape.
TEST(NearFlatCornersInDouble, AreHitFromAfar) {
  Draw draw(5);
  for (int i = 0; i < 3000; ++i) {
    const double cut = draw.spread(1e-15, 1e-4), angle = draw.even(-4, 4), way = draw.even(-4, 4);
    Polygon polygon;
    for (const Vec2d corner : {Vec2d{-0.5, -0.5}, Vec2d{0.5, -0.5}, Vec2d{0.5, 0.5}, Vec2d{-0.5, 0.5}}) {
      polygon.points.push_back({corner.x * (1 - cut * draw.even(0.1, 1)), corner.y});
      polygon.points.push_back({corner.x, corner.y * (1 - cut * draw.even(0.1, 1))});
    }
    DoubleWorld world;
    world.create_body({.type = BodyType::Static, .angle = angle}, {.geometry = polygon});
    for (const double far : {1.0, 1e3, 1e6}) {
      const Vec2d along = rotated({1, 0}, way);
      const Vec2d from = -far * along + draw.even(-0.45, 0.45) * perpendicular(along);
      const auto hit = ray_cast_closest(world, from, 2 * far * along);
      ASSERT_TRUE(hit) << i;
      // A line enters the unit square at the last of its entries through the two pairs of sides.
      const Vec2d start = rotated(from, -angle), direction = rotated(along, -angle);
      const double enters =
          std::max((-0.5 - std::copysign(1.0, direction.x) * start.x) / std::fabs(direction.x),
                   (-0.5 - std::copysign(1.0, direction.y) * start.y) / std::fabs(direction.y));
      EXPECT_NEAR(hit->fraction * 2 * far, enters, 4 * cut + 1e-12 + 1e-14 * far) << i;
    }
  }
}

}  // namespace
}  // namespace plumb
