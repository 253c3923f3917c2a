#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/scene/error.h"
#include "tests/world/support.h"

/// Definitions can be read back, and users' own combine rules.
namespace plumb {
namespace {

TEST(Readers, TellWhatABodyWasMadeFrom) {
  World world;
  const BodyId body = world.create_body({.name = "crate",
                                         .gravity_scale = 0.5,
                                         .linear_damping = 0.25,
                                         .angular_damping = 0.125,
                                         .lock_y = true,
                                         .may_sleep = false,
                                         .user_data = 7});
  EXPECT_EQ(world.gravity_scale(body), 0.5);
  EXPECT_EQ(world.linear_damping(body), 0.25);
  EXPECT_EQ(world.angular_damping(body), 0.125);
  EXPECT_EQ(world.locks(body), (BodyLocks{.y = true}));
  EXPECT_FALSE(world.may_sleep(body));
  EXPECT_EQ(world.user_data(body), 7u);
  world.set_damping(body, 2, 3);
  world.set_gravity_scale(body, -1);
  world.set_locks(body, true, false, true);
  world.set_may_sleep(body, true);
  EXPECT_EQ(world.linear_damping(body), 2);
  EXPECT_EQ(world.angular_damping(body), 3);
  EXPECT_EQ(world.gravity_scale(body), -1);
  EXPECT_EQ(world.locks(body), (BodyLocks{.x = true, .rotation = true}));
  EXPECT_TRUE(world.may_sleep(body));
}

TEST(Readers, TellWhatAShapeAndAChainWereMadeFrom) {
  World world;
  const BodyId body = world.create_body({});
  const ShapeId plain = world.create_shape(body, {.density = 3.5, .hit_events = true});
  const ShapeId other = world.create_shape(body, {.sensor = true, .pre_solve = true, .user_data = 5});
  EXPECT_EQ(world.density(plain), 3.5);
  EXPECT_TRUE(world.hit_events(plain));
  EXPECT_FALSE(world.sensor(plain) || world.pre_solve(plain));
  EXPECT_TRUE(world.sensor(other) && world.pre_solve(other));
  EXPECT_FALSE(world.hit_events(other));
  EXPECT_EQ(world.user_data(other), 5u);
  const BodyId ground = world.create_body({.type = BodyType::Static});
  const ChainId chain = world.create_chain(ground, {.points = {{0, 0}, {1, 0}, {2, 1}}, .user_data = 9});
  EXPECT_EQ(world.body(chain), ground);
  for (const ShapeId segment : world.segments(chain)) EXPECT_EQ(world.user_data(segment), 9u);
}

// The values put in, after their transformation by hand.
TEST(Readers, GiveShapesBackAsDefinitions) {
  World world;
  // The centre of mass is not the body's origin.
  const BodyId body = world.create_body({.position = {3, 4}, .angle = 1});
  const double quarter = 1.57079632679489662;
  const ShapeId disc = world.create_shape(body, {.geometry = Circle{0.25}, .position = {2, 1}, .density = 3});
  const ShapeId capsule = world.create_shape(
      body, {.geometry = Capsule{{0, 0}, {1, 0}, 0.125}, .position = {1, 2}, .angle = quarter});
  const ShapeId box = world.create_shape(
      body, {.geometry = Box{2, 1}, .position = {-1, 0}, .material = {.friction = 0.5}, .user_data = 6});
  const ShapeId round = world.create_shape(
      body, {.geometry = Polygon{{{0, 0}, {1, 0}, {0, 1}}, 0.0625}, .sensor = true, .hit_events = true});
  const ShapeId line = world.create_shape(body, {.geometry = Segment{{0, -1}, {2, -1}}, .pre_solve = true});
  const auto near = [](Vec2d a, Vec2d b) { return length_squared(a - b) < 1e-12; };

  const ShapeDefinition circle = world.definition(disc);
  EXPECT_EQ(std::get<Circle>(circle.geometry), Circle{0.25});
  EXPECT_TRUE(near(circle.position, {2, 1}));
  EXPECT_EQ(circle.density, 3);
  const Capsule pill = std::get<Capsule>(world.definition(capsule).geometry);
  EXPECT_TRUE(near(pill.start, {1, 2}) && near(pill.end, {1, 3}));
  EXPECT_EQ(pill.radius, 0.125);
  const ShapeDefinition crate = world.definition(box);
  const Polygon corners = std::get<Polygon>(crate.geometry);
  ASSERT_EQ(corners.points.size(), 4u);
  EXPECT_EQ(corners.radius, 0);
  for (const Vec2d corner : {Vec2d{-2, -0.5}, Vec2d{0, -0.5}, Vec2d{0, 0.5}, Vec2d{-2, 0.5}})
    EXPECT_EQ(std::ranges::count_if(corners.points, [&](Vec2d p) { return near(p, corner); }), 1);
  EXPECT_EQ(crate.material.friction, 0.5);
  EXPECT_EQ(crate.user_data, 6u);
  const ShapeDefinition triangle = world.definition(round);
  EXPECT_EQ(std::get<Polygon>(triangle.geometry).points.size(), 3u);
  EXPECT_EQ(std::get<Polygon>(triangle.geometry).radius, 0.0625);
  EXPECT_TRUE(triangle.sensor && triangle.hit_events && !triangle.pre_solve);
  const Segment segment = std::get<Segment>(world.definition(line).geometry);
  EXPECT_TRUE(near(segment.start, {0, -1}) && near(segment.end, {2, -1}));
  EXPECT_TRUE(world.definition(line).pre_solve);
  world.destroy(line);
  EXPECT_THROW(world.definition(line), Error);

  // Added again, they make the same body.
  const BodyId copy = world.create_body({.position = {3, 4}, .angle = 1});
  for (const ShapeId shape : {disc, capsule, box, round}) world.create_shape(copy, world.definition(shape));
  EXPECT_NEAR(world.mass(copy), world.mass(body), 1e-6 * world.mass(body));
  EXPECT_NEAR(world.inertia(copy), world.inertia(body), 1e-6 * world.inertia(body));
  EXPECT_TRUE(near(world.centre(copy), world.centre(body)));
}

TEST(Readers, GiveChainsBackAsDefinitions) {
  World world;
  const BodyId ground = world.create_body({.type = BodyType::Static, .position = {5, 0}});
  const std::vector<Vec2d> points = {{0, 0}, {1, 0.5}, {2, 0}, {2, 3}};
  for (const bool closed : {false, true}) {
    const ChainId chain = world.create_chain(ground, {.points = points,
                                                      .closed = closed,
                                                      .material = {.friction = 0.25},
                                                      .filter = {.group = 3},
                                                      .user_data = 8});
    const ChainDefinition read = world.definition(chain);
    EXPECT_EQ(read.points, points);
    EXPECT_EQ(read.closed, closed);
    EXPECT_EQ(read.material.friction, 0.25);
    EXPECT_EQ(read.filter.group, 3);
    EXPECT_EQ(read.user_data, 8u);
    world.destroy(chain);
    EXPECT_THROW(world.definition(chain), Error);
  }
}

TEST(Readers, TellWhatAJointWasMadeFrom) {
  World world;
  const BodyId a = world.create_body({.type = BodyType::Static}), b = add_box(world, {1, 0});
  const JointId joint = world.create_joint(a, b,
                                           {.kind = RevoluteDefinition{.limits = Range{-1, 1}},
                                            .collide = true,
                                            .break_force = 11,
                                            .break_torque = 13,
                                            .user_data = 17});
  const JointDefinition read = world.definition(joint);
  EXPECT_EQ(std::get<RevoluteDefinition>(read.kind).limits, (Range{-1, 1}));
  EXPECT_TRUE(read.collide);
  EXPECT_EQ(read.break_force, 11);
  EXPECT_EQ(read.break_torque, 13);
  EXPECT_EQ(read.user_data, 17u);
  EXPECT_EQ(world.user_data(joint), 17u);
  world.destroy(joint);
  EXPECT_THROW(world.user_data(joint), Error);
  EXPECT_THROW(world.definition(joint), Error);
}

// Harmonic mean.
double harmonic(double a, double b) { return a + b > 0 ? 2 * a * b / (a + b) : 0; }
double half_the_sum(double a, double b) { return 0.5 * a + 0.5 * b; }

// A box slides with v0 to rest in v0^2 / (2 mu g); the means of 0.2 and 0.6 are 0.3 (harmonic) and 0.35
// (geometric).
double slide(CombineFunction rule) {
  DoubleWorld world(without_sleep());
  world.combine_with(rule, nullptr);
  add_ground(world, {.friction = 0.6});
  const BodyId box = add_body(world, {0, 0.1},
                              {.geometry = Box{2, 0.2}, .density = 1, .material = {.friction = 0.2}}, {3, 0});
  run(world, 180);
  return world.position(box).x;
}

TEST(CombineWith, AUsersRuleMixesFriction) {
  const double expected = 9 / (2 * 0.3 * kGravity);
  EXPECT_NEAR(slide(harmonic), expected, 0.02);
  EXPECT_LT(slide(nullptr), expected - 0.1);
}

TEST(CombineWith, AUsersRuleMixesRestitution) {
  DoubleWorld world(without_sleep());
  world.combine_with(nullptr, half_the_sum);
  add_ground(world, {.restitution = 0});
  const BodyId ball =
      add_body(world, {0, 2.5}, {.geometry = Circle{0.5}, .density = 1, .material = {.restitution = 1}});
  double before = 0, ratio = 0;
  for (int i = 0; i < 120 && ratio == 0; ++i) {
    world.step();
    const double now = world.velocity(ball).y;
    if (before < 0 && now > 0) ratio = -now / before;
    before = now;
  }
  EXPECT_NEAR(ratio, 0.5, 0.02);
}

TEST(CombineWith, AnswersThatAreNoCoefficientAreRefused) {
  for (const CombineFunction rule : {CombineFunction{[](double, double) { return -1.0; }},
                                     CombineFunction{[](double, double) { return std::nan(""); }}}) {
    World world;
    world.combine_with(rule, nullptr);
    add_ground(world);
    add_box(world, {0, 0.5});
    EXPECT_THROW(run(world, 2), Error);
  }
}

}  // namespace
}  // namespace plumb
