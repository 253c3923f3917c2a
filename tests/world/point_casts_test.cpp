#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "engine/world/queries.h"
#include "tests/world/passages.h"
#include "tests/world/support.h"

// Casts of points and lines, which have no inside that would tell from which side they come.
namespace plumb {
namespace {

using passages::Draw;
using std::numbers::pi;

template <class Real>
class PointCasts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(PointCasts, Reals);

Vec2d rotated(Vec2d p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

TYPED_TEST(PointCasts, HitWhatRaysHit) {
  BasicWorld<TypeParam> world;
  const BodyId ground = world.create_body({.type = BodyType::Static});
  world.create_chain(ground, {.points = {{5, 0.2}, {1, -0.3}, {-5, 0.4}}});
  world.create_shape(ground, {.geometry = Segment{{-1, 1.2}, {1, 1.4}}});
  world.create_shape(ground, {.geometry = Polygon{{{2, 1}, {3, 1.1}, {2.4, 1.7}}}});
  const QueryShape point = QueryShape::box(0, 0);
  Draw draw(1);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec2d from{draw.even(-4, 4), draw.even(-1, 3)}, way{draw.even(-4, 4), draw.even(-8, 8)};
    const auto ray = ray_cast_closest(world, from, way);
    const auto cast = cast_shape_closest(world, point, from, 0, way);
    if (cast && cast->overlapped) continue;  // rays ignore a shape that they start in
    ASSERT_EQ(ray.has_value(), cast.has_value())
        << from.x << ", " << from.y << " by " << way.x << ", " << way.y;
    if (!ray) continue;
    ++hits;
    EXPECT_EQ(ray->shape, cast->shape);
    EXPECT_NEAR(ray->fraction, cast->fraction, 1e-12);
    EXPECT_NEAR(ray->normal.x, cast->normal.x, 1e-6);
    EXPECT_NEAR(ray->normal.y, cast->normal.y, 1e-6);
    EXPECT_LT(dot(cast->normal, way), 0);
  }
  EXPECT_GT(hits, 2000);
}

TYPED_TEST(PointCasts, LinesAlongAChainLandOnIt) {
  Draw draw(2);
  for (int i = 0; i < 2000; ++i) {
    const double angle = draw.even(-pi, pi), far = draw.even(0, 1000);
    const Vec2d position = rotated({far, 0}, draw.even(-pi, pi)), out = rotated({0, 1}, angle);
    BasicWorld<TypeParam> world;
    world.create_chain(world.create_body({.type = BodyType::Static, .position = position, .angle = angle}),
                       {.points = {{2, 0}, {-2, 0}}});
    const QueryShape line = QueryShape::box(draw.even(0.1, 3), 0);
    const auto cast = cast_shape_closest(world, line, position + out, angle, -2.0 * out);
    ASSERT_TRUE(cast) << i;
    EXPECT_NEAR(cast->fraction, 0.5, 1e-6);
    EXPECT_GT(dot(cast->normal, out), 1 - 1e-6);
    EXPECT_FALSE(cast_shape_closest(world, line, position - out, angle, 2.0 * out)) << "from behind";
  }
}

TYPED_TEST(PointCasts, LeaveNoRoomThroughItsCorners) {
  const QueryShape point = QueryShape::box(0, 0);
  Draw draw(3);
  for (const double far : {0.0, 1000.0})
    for (const double angle : {0.0, 0.7})
      for (int i = 0; i < 200; ++i) {
        BasicWorld<TypeParam> world({.gravity = {}});
        const BodyId body =
            world.create_body({.type = BodyType::Static, .position = {far, far}, .angle = angle});
        ChainDefinition room;
        room.closed = true;
        const int corners = 3 + draw.choose(10);
        for (int k = 0; k < corners; ++k)
          room.points.push_back(rotated({draw.even(7, 13), 0}, -2 * pi * k / corners));
        world.create_chain(body, room);
        for (const Vec2d corner : room.points) {
          const Vec2d from{far + draw.even(-1, 1), far + draw.even(-1, 1)};
          const Vec2d way = 3.0 * (world.world_point(body, corner) - from);
          const auto cast = cast_shape_closest(world, point, from, 0, way);
          ASSERT_TRUE(cast) << "room " << i;
          EXPECT_NEAR(cast->fraction, 1.0 / 3, 1e-5);
          EXPECT_LT(dot(cast->normal, way), 0);
        }
      }
}

// A segment has no front: it is met from either side, with the normal towards where the shape came from.
TYPED_TEST(PointCasts, MeetASegmentFromBothSides) {
  Draw draw(4);
  for (int i = 0; i < 2000; ++i) {
    const double angle = draw.even(-pi, pi);
    BasicWorld<TypeParam> world;
    world.create_body({.type = BodyType::Static, .angle = angle}, {.geometry = Segment{{-2, 0}, {2, 0}}});
    const QueryShape shape = QueryShape::box(i % 2 == 0 ? 0 : draw.even(0.1, 3), 0);
    for (const double side : {-1.0, 1.0}) {
      const Vec2d out = rotated({0, side}, angle), aside = rotated({draw.even(-1, 1), 0}, angle);
      const auto cast = cast_shape_closest(world, shape, out + aside, angle, -2.0 * out);
      ASSERT_TRUE(cast) << i;
      EXPECT_NEAR(cast->fraction, 0.5, 1e-6);
      EXPECT_GT(dot(cast->normal, out), 1 - 1e-6);
    }
  }
}

TYPED_TEST(PointCasts, ThatTouchHitOnlyWhereTheyEnter) {
  BasicWorld<TypeParam> world;
  const BodyId ground = world.create_body({.type = BodyType::Static});
  world.create_shape(ground, {.geometry = Box{2, 2}});
  const ShapeId thin = world.create_shape(ground, {.geometry = Segment{{9, 0}, {11, 0}}});
  const QueryShape point = QueryShape::box(0, 0), line = QueryShape::box(0.5, 0);
  for (const QueryShape* shape : {&point, &line}) {
    const auto into = cast_shape_closest(world, *shape, {0, 1}, 0, {0.3, -1});
    ASSERT_TRUE(into);
    EXPECT_EQ(into->fraction, 0);
    EXPECT_EQ(into->normal, (Vec2d{0, 1}));
    EXPECT_FALSE(cast_shape_closest(world, *shape, {0, 1}, 0, {1, 0})) << "along it";
    EXPECT_FALSE(cast_shape_closest(world, *shape, {0, 1}, 0, {0.3, 1})) << "away";
    for (const double y : {-1.0, 1.0})
      EXPECT_FALSE(cast_shape_closest(world, *shape, {10, 0}, 0, {0, y})) << "off a line";
  }
  // At a corner the normals of both sides belong to the contact.
  EXPECT_TRUE(cast_shape_closest(world, point, {1, 1}, 0, {-1, -1}));
  for (const Vec2d way : {Vec2d{-1, 0.5}, Vec2d{0.5, -1}, Vec2d{-1, 0}, Vec2d{0, -1}})
    EXPECT_FALSE(cast_shape_closest(world, point, {1, 1}, 0, way)) << way.x << ", " << way.y;
  EXPECT_TRUE(contains(world, thin, {10, 0}));
}

}  // namespace
}  // namespace plumb
