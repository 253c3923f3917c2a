#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/scene/error.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

using std::numbers::pi;

TEST(Shapes, MassFollowsFromDensities) {
  DoubleWorld world;
  const BodyId disc = add_body(world, {}, {.geometry = Circle{2}, .density = 3});
  EXPECT_NEAR(world.mass(disc), 12 * pi, 1e-12);
  EXPECT_NEAR(world.inertia(disc), 12 * pi * 4 / 2, 1e-11);
  const BodyId capsule = add_body(world, {}, {.geometry = Capsule{{-1, 0}, {1, 0}, 0.5}});
  EXPECT_NEAR(world.mass(capsule), 2 + pi / 4, 1e-12);
  const BodyId triangle = add_body(world, {}, {.geometry = Polygon{{{0, 0}, {3, 0}, {0, 3}}}});
  EXPECT_NEAR(world.mass(triangle), 4.5, 1e-12);
  EXPECT_NEAR(world.centre(triangle).x, 1, 1e-12);
  EXPECT_NEAR(world.centre(triangle).y, 1, 1e-12);
  // I of a right triangle with legs a about its centroid: m a^2 / 9.
  EXPECT_NEAR(world.inertia(triangle), 4.5 * 9 / 9, 1e-12);
}

TEST(Shapes, CompoundsBalanceAboutTheirCentre) {
  DoubleWorld world;
  const ShapeDefinition parts[] = {{.geometry = Box{1, 1}, .position = {-1, 0}, .density = 1},
                                   {.geometry = Box{1, 1}, .position = {1, 0}, .density = 3}};
  const BodyId dumbbell = world.create_body({}, parts);
  EXPECT_NEAR(world.mass(dumbbell), 4, 1e-12);
  EXPECT_NEAR(world.centre(dumbbell).x, 0.5, 1e-12);
  EXPECT_EQ(world.position(dumbbell).x, 0);
  const double own = 1.0 / 6;  // of a unit square, per kg
  EXPECT_NEAR(world.inertia(dumbbell), 1 * (own + 2.25) + 3 * (own + 0.25), 1e-12);
  // Shapes that come later weigh as well, and the origin stays where it was.
  const ShapeId third =
      world.create_shape(dumbbell, {.geometry = Box{1, 1}, .position = {0, 4}, .density = 4});
  EXPECT_NEAR(world.centre(dumbbell).y, 2, 1e-12);
  EXPECT_NEAR(world.position(dumbbell).y, 0, 1e-12);
  world.destroy(third);
  EXPECT_NEAR(world.centre(dumbbell).y, 0, 1e-12);
  EXPECT_NEAR(world.mass(dumbbell), 4, 1e-12);
}

TEST(Shapes, MassMayBeGiven) {
  DoubleWorld world;
  BodyDefinition definition;
  definition.mass = MassProperties{7, {0.25, 0}, 2};
  const BodyId body = world.create_body(definition, ShapeDefinition{.geometry = Box{1, 1}});
  EXPECT_EQ(world.mass(body), 7);
  EXPECT_EQ(world.inertia(body), 2);
  EXPECT_EQ(world.centre(body).x, 0.25);
  world.use_densities(body);
  EXPECT_NEAR(world.mass(body), 1, 1e-12);
  EXPECT_NEAR(world.centre(body).x, 0, 1e-12);
}

// Every kind of shape comes to rest on every kind of ground where its form says.
struct Resting {
  const char* name;
  ShapeGeometry geometry;
  double height;  // of the centre of mass above the ground, at rest
};

class ShapesRest : public testing::TestWithParam<Resting> {};

TEST_P(ShapesRest, OnABoxASegmentAndAChain) {
  for (int ground = 0; ground < 3; ++ground) {
    SCOPED_TRACE(ground);
    World world(without_sleep());
    BodyDefinition still;
    still.type = BodyType::Static;
    const BodyId floor = world.create_body(still);
    if (ground == 0) world.create_shape(floor, {.geometry = Box{20, 2}, .position = {0, -1}});
    if (ground == 1) world.create_shape(floor, {.geometry = Segment{{-10, 0}, {10, 0}}});
    if (ground == 2) world.create_chain(floor, {.points = {{10, 0}, {1.3, 0}, {-0.2, 0}, {-10, 0}}});
    const BodyId body = add_body(world, {0, 2}, {.geometry = GetParam().geometry});
    run(world, 300);
    EXPECT_NEAR(world.centre(body).y, GetParam().height, 1e-3);
    EXPECT_NEAR(std::hypot(world.velocity(body).x, world.velocity(body).y), 0, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ShapesRest,
    testing::Values(Resting{"Circle", Circle{0.5}, 0.5}, Resting{"Box", Box{1, 0.6}, 0.3},
                    Resting{"Capsule", Capsule{{-0.5, 0}, {0.5, 0}, 0.25}, 0.25},
                    Resting{"Triangle", Polygon{{{-1, 0}, {1, 0}, {0, 1.5}}}, 0.5},
                    Resting{"RoundedBox", Polygon{{{-0.4, -0.3}, {0.4, -0.3}, {0.4, 0.3}, {-0.4, 0.3}}, 0.1},
                            0.4}),
    [](const auto& each) { return each.param.name; });

TEST(Shapes, ChainsHaveAFrontOnly) {
  World world(weightless());
  BodyDefinition still;
  still.type = BodyType::Static;
  const BodyId floor = world.create_body(still);
  world.create_chain(floor, {.points = {{5, 0}, {-5, 0}}});  // front: up
  const BodyId from_above = add_body(world, {0, 2}, {.geometry = Circle{0.3}}, {0, -3});
  const BodyId from_below = add_body(world, {2, -2}, {.geometry = Circle{0.3}}, {0, 3});
  run(world, 120);
  EXPECT_GT(world.position(from_above).y, 0.29);
  EXPECT_GT(world.position(from_below).y, 3);
}

TEST(Shapes, NothingCatchesAtTheSeamsOfAChain) {
  World world(without_sleep());
  BodyDefinition still;
  still.type = BodyType::Static;
  ChainDefinition chain;
  for (int i = 400; i >= -100; --i) chain.points.push_back({0.5 * i, 0});
  chain.material.friction = 0;
  world.create_chain(world.create_body(still), chain);
  const BodyId box =
      add_body(world, {-40, 0.5}, {.geometry = Box{1, 1}, .material = {.friction = 0}}, {30, 0});
  const BodyId ball =
      add_body(world, {-30, 0.25}, {.geometry = Circle{0.25}, .material = {.friction = 0}}, {45, 0});
  run(world, 240);
  EXPECT_NEAR(world.velocity(box).x, 30, 1e-4);
  EXPECT_NEAR(world.position(box).y, 0.5, 1e-3);
  EXPECT_NEAR(world.velocity(ball).x, 45, 1e-4);
}

TEST(Shapes, AClosedChainHoldsWhatIsInside) {
  World world(without_sleep());
  BodyDefinition still;
  still.type = BodyType::Static;
  // Clockwise as seen from inside to the right of the way: the front faces in.
  world.create_chain(world.create_body(still),
                     {.points = {{-2, 0}, {-2, 4}, {2, 4}, {2, 0}}, .closed = true});
  const BodyId ball =
      add_body(world, {0, 2}, {.geometry = Circle{0.3}, .material = {.restitution = 0.9}}, {9, 4});
  for (int i = 0; i < 600; ++i) {
    world.step();
    const Vec2d at = world.position(ball);
    ASSERT_TRUE(std::abs(at.x) < 1.75 && at.y > 0.25 && at.y < 3.75) << at.x << " " << at.y;
  }
}

TEST(Shapes, BadOnesAreRefusedAndChangeNothing) {
  World world;
  const BodyId body = world.create_body({});
  const std::uint64_t before = world.hash();
  const auto refused = [&](const ShapeDefinition& shape, const char* field) {
    try {
      world.create_shape(body, shape);
      ADD_FAILURE() << field;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Value);
      EXPECT_EQ(error.subject(), "shape of body 0");
      EXPECT_EQ(error.field(), field);
    }
  };
  refused({.geometry = Circle{0}}, "radius");
  refused({.geometry = Circle{std::nan("")}}, "radius");
  refused({.geometry = Box{1, -1}}, "height");
  refused({.geometry = Capsule{{0, 0}, {1e300, 0}, 1}}, "end");
  refused({.geometry = Polygon{{{0, 0}, {1, 1}, {2, 2}}}}, "points");
  refused({.geometry = Segment{{1, 1}, {1, 1}}}, "end");
  refused({.density = -1}, "density");
  refused({.material = {.friction = -0.1}}, "friction");
  refused({.material = {.restitution = 1.1}}, "restitution");
  EXPECT_EQ(world.hash(), before);
  EXPECT_EQ(world.counts().shapes, 0);
  EXPECT_THROW(world.create_body({}, ShapeDefinition{.geometry = Polygon{{{0, 0}, {1, 0}}}}), Error);
  EXPECT_EQ(world.counts().bodies, 1);
}

}  // namespace
}  // namespace plumb
