#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/world/snapshot.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

TEST(Materials, FrictionSlowsAtMuG) {
  World world(without_sleep());
  add_ground(world, {.friction = 0.4});
  const BodyId box =
      add_body(world, {0, 0.25}, {.geometry = Box{4, 0.5}, .material = {.friction = 0.4}}, {8, 0});
  run(world, 60);
  // A wide, flat box: it does not tip. Each of 240 substeps rounds to half an ulp of 8: 240 * 2.4e-7 m/s.
  EXPECT_NEAR(world.velocity(box).x, 8 - 0.4 * kGravity, 6e-5);
  run(world, 90);
  // The rest is the rounding of a substep's friction: 2^-24 mu g h.
  EXPECT_NEAR(world.velocity(box).x, 0, 0x1p-24 * 0.4 * kGravity / 240);
}

TEST(Materials, CombineRulesAreTheWorlds) {
  for (const auto& [rule, friction] : {std::pair{Combine::GeometricMean, 0.4},
                                       {Combine::Product, 0.16},
                                       {Combine::Maximum, 0.8},
                                       {Combine::Minimum, 0.2},
                                       {Combine::Average, 0.5}}) {
    World world({.combine_friction = rule, .sleeping = false});
    add_ground(world, {.friction = 0.2});
    const BodyId box =
        add_body(world, {0, 0.25}, {.geometry = Box{4, 0.5}, .material = {.friction = 0.8}}, {10, 0});
    run(world, 30);
    // 120 substeps, half an ulp of 10 each.
    EXPECT_NEAR(world.velocity(box).x, 10 - friction * kGravity / 2, 120 * 0x1p-21);
  }
}

TEST(Materials, RestitutionIsNewtons) {
  for (const double restitution : {0.0, 0.3, 0.8, 1.0}) {
    World world(weightless());
    BodyDefinition wall;
    wall.type = BodyType::Static;
    world.create_body(wall, ShapeDefinition{.geometry = Box{1, 10}});
    const BodyId ball = add_body(
        world, {3.017, 0}, {.geometry = Circle{0.5}, .material = {.restitution = restitution}}, {-4, 0});
    run(world, 90);
    EXPECT_NEAR(world.velocity(ball).x, 4 * restitution, 1e-5);
  }
}

TEST(Materials, EqualBallsSwapVelocities) {
  World world(weightless());
  const ShapeDefinition disc{.geometry = Circle{0.5}, .material = {.friction = 0, .restitution = 1}};
  const BodyId a = add_body(world, {0, 0}, disc, {3, 0}), b = add_body(world, {2.013, 0}, disc, {-1, 0});
  run(world, 60);
  EXPECT_NEAR(world.velocity(a).x, -1, 1e-5);
  EXPECT_NEAR(world.velocity(b).x, 3, 1e-5);
}

TEST(Materials, RollingResistanceSlowsAWheel) {
  World world(without_sleep());
  add_ground(world);
  const double v = 5, r = 0.5, c = 0.1;
  BodyDefinition body;
  body.position = {0, r};
  body.velocity = {v, 0};
  body.angular_velocity = -v / r;
  const BodyId wheel =
      world.create_body(body, ShapeDefinition{.geometry = Circle{r}, .material = {.rolling_resistance = c}});
  run(world, 60);
  // Torque c r m g against rolling: a = -(2/3) c g for a disc that does not slip.
  // 240 substeps round it to half an ulp of 5: 6e-5.
  EXPECT_NEAR(world.velocity(wheel).x, v - 2.0 / 3 * c * kGravity, 240 * 0x1p-22);
}

TEST(Materials, ConveyorsCarry) {
  World world(without_sleep());
  add_ground(world, {.surface_speed = 2});
  const BodyId box = add_box(world, {0, 0.5});
  run(world, 240);
  // Friction asks for the belt's speed itself: an ulp of 2 is left when the box has stopped rocking.
  EXPECT_NEAR(world.velocity(box).x, 2, 0x1p-22);
}

// A tracked vehicle: what its shape's surface does to the ground is what a belt does to a box, whichever came
// first.
TEST(Materials, TracksDriveOnGroundAndBelt) {
  for (const double belt : {0.0, 3.0}) {
    World world(without_sleep());
    add_ground(world, {.surface_speed = belt});
    const BodyId box = add_body(world, {0, 0.5}, {.geometry = Box{1, 1}, .material = {.surface_speed = 2}});
    run(world, 240);
    EXPECT_NEAR(world.velocity(box).x, 2 + belt, 2 * 0x1p-22) << "belt at " << belt;
  }
}

TEST(Materials, CanChangeWhileTheWorldRuns) {
  World world(without_sleep());
  add_ground(world, {.friction = 1});
  const BodyId box =
      add_body(world, {0, 0.25}, {.geometry = Box{4, 0.5}, .material = {.friction = 1}}, {20, 0});
  run(world, 30);
  const double before = world.velocity(box).x;
  world.set_material(world.shapes(box)[0], {.friction = 0});
  run(world, 60);
  EXPECT_NEAR(world.velocity(box).x, before, kGravity / 60);
  EXPECT_NEAR(world.position(box).y, 0.25, 1e-3);
}

TEST(Filters, DecideWhatTouches) {
  struct Case {
    Filter ground, ball;
    bool rests;
  };
  for (const Case& c : {Case{{}, {}, true}, Case{{.category = 2}, {.mask = 1}, false},
                        Case{{.mask = 4}, {.category = 2}, false}, Case{{.category = 2}, {.mask = 3}, true},
                        Case{{.group = -5}, {.group = -5}, false},
                        Case{{.mask = 0, .group = 7}, {.mask = 0, .group = 7}, true}}) {
    World world;
    BodyDefinition still;
    still.type = BodyType::Static;
    world.create_body(still,
                      ShapeDefinition{.geometry = Box{20, 2}, .position = {0, -1}, .filter = c.ground});
    const BodyId ball = add_body(world, {0, 1}, {.geometry = Circle{0.5}, .filter = c.ball});
    run(world, 120);
    EXPECT_EQ(world.position(ball).y > 0, c.rests) << c.ball.category << " " << c.ball.mask;
  }
}

TEST(Filters, CanChangeWhileTheWorldRuns) {
  World world;
  add_ground(world);
  const BodyId ball = add_body(world, {0, 0.5}, {.geometry = Circle{0.5}});
  run(world, 200);
  EXPECT_FALSE(world.awake(ball));
  world.set_filter(world.shapes(ball)[0], {.mask = 0});
  run(world, 60);
  EXPECT_LT(world.position(ball).y, -2);
}

TEST(Filters, TheBoxFollowsABodyThatMeetsNothing) {
  World world;
  const BodyId ball = add_body(world, {0, 40}, {.geometry = Circle{0.5}, .filter = {.mask = 0}});
  run(world, 60);
  const Vec2d centre = world.position(ball);
  EXPECT_LT(centre.y, 36);
  for (const Aabb<double>& box : {world.box(ball), world.box(world.shapes(ball)[0])}) {
    EXPECT_NEAR(box.lower.y, centre.y - 0.5, 1e-5);
    EXPECT_NEAR(box.upper.y, centre.y + 0.5, 1e-5);
  }
}

// Shapes that nothing can meet have no box in the trees: one gets its box in place when its filter lets it
// meet things, also in a world that was restored, on a body of another type, and beside a shape of its body
// that has one.
TEST(Filters, WhatMetNothingMeetsThingsLater) {
  for (const bool beside : {false, true}) {
    World world;
    add_ground(world);
    const BodyId ball = add_body(world, {0, 40}, {.geometry = Circle{0.5}, .filter = {.mask = 0}});
    const ShapeId large = world.shapes(ball)[0];
    if (beside) world.create_shape(ball, {.geometry = Circle{0.2}, .density = 0});
    run(world, 60);
    world.set_type(ball, BodyType::Kinematic);
    run(world, 3);
    world.set_type(ball, BodyType::Dynamic);
    world.set_velocity(ball, {0, -4000});  // fast: it is swept
    world.step();
    EXPECT_LT(world.position(ball).y, beside ? 21.0 : -2.0);
    world.set_position(ball, {0, 20}, 0);
    world.set_velocity(ball, {});
    World other;
    restore(other, save(world));
    for (World* each : {&world, &other}) {
      each->set_filter(large, {});
      run(*each, 300);
      EXPECT_NEAR(each->position(ball).y, 0.5, 0.005);
    }
    EXPECT_EQ(world.hash(), other.hash());
  }
}

TEST(Events, TouchingBeginsAndEnds) {
  World world;
  const BodyId ground = add_ground(world);
  const BodyId ball = add_body(world, {0, 2}, {.geometry = Circle{0.5}});
  int began = 0, ended = 0;
  const auto count = [&] {
    began += static_cast<int>(world.events().begin.size());
    ended += static_cast<int>(world.events().end.size());
    for (const TouchEvent& event : world.events().begin) {
      const BodyId first = world.body(event.shape_a), second = world.body(event.shape_b);
      EXPECT_TRUE((first == ground && second == ball) || (first == ball && second == ground));
    }
  };
  for (int i = 0; i < 120; ++i) world.step(), count();
  EXPECT_EQ(began, 1);
  EXPECT_EQ(ended, 0);
  world.apply_impulse(ball, {0, 5});
  for (int i = 0; i < 20; ++i) world.step(), count();
  EXPECT_EQ(ended, 1);
  for (int i = 0; i < 200; ++i) world.step(), count();
  EXPECT_EQ(began, 2);
  world.destroy(ball);
  world.step(), count();
  EXPECT_EQ(ended, 2);
}

TEST(Events, HitsTellTheSpeed) {
  World world(weightless());
  add_ground(world);
  const BodyId ball = add_body(world, {0, 2}, {.geometry = Circle{0.5}, .hit_events = true}, {0, -7});
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    for (const HitEvent& hit : world.events().hits) {
      ++hits;
      EXPECT_NEAR(hit.speed, 7, 1e-5);
      EXPECT_NEAR(std::abs(hit.normal.y), 1, 1e-6);
      EXPECT_NEAR(hit.point.y, 0, 0.1);
    }
  }
  EXPECT_EQ(hits, 1);
  EXPECT_TRUE(world.valid(ball));
}

TEST(Events, SensorsSeeAndDoNotTouch) {
  World world;
  BodyDefinition still;
  still.type = BodyType::Static;
  const ShapeId gate = world.create_shape(world.create_body(still), {.geometry = Box{4, 1}, .sensor = true});
  const BodyId ball = add_body(world, {0, 3}, {.geometry = Circle{0.5}});
  int began = 0, ended = 0;
  for (int i = 0; i < 120; ++i) {
    world.step();
    began += static_cast<int>(world.events().sensor_begin.size());
    ended += static_cast<int>(world.events().sensor_end.size());
    const bool inside = std::abs(world.position(ball).y) < 1;
    EXPECT_EQ(world.overlapping(gate).size(), inside ? 1u : 0u);
  }
  EXPECT_EQ(began, 1);
  EXPECT_EQ(ended, 1);
  EXPECT_NEAR(world.position(ball).y, 3 - kGravity * 4 / 2, 1e-3);
}

TEST(Events, PreSolveMakesOneWayPlatforms) {
  World world(without_sleep());
  BodyDefinition still;
  still.type = BodyType::Static;
  const ShapeId platform =
      world.create_shape(world.create_body(still), {.geometry = Box{4, 0.2}, .pre_solve = true});
  const BodyId ball = add_body(world, {0, -2}, {.geometry = Circle{0.25}}, {0, 9});
  world.on_pre_solve([&](const ContactReading& contact) {
    const bool platform_first = contact.shape_a == platform;
    const double up = platform_first ? contact.normal.y : -contact.normal.y;
    return up > 0.5 && world.velocity(ball).y <= 0.01;
  });
  double highest = -9;
  for (int i = 0; i < 240; ++i) {
    world.step();
    highest = std::max(highest, world.position(ball).y);
  }
  EXPECT_NEAR(highest, -2 + 81 / (2 * kGravity), 1e-2);
  EXPECT_NEAR(world.position(ball).y, 0.35, 1e-3);
}

// As a game lets a character drop through a platform: the answer changes while they touch.
TEST(Events, PreSolveLetsGoOfWhatRests) {
  World world(without_sleep());
  const ShapeId platform = world.create_shape(world.create_body({.type = BodyType::Static}),
                                              {.geometry = Box{4, 0.2}, .pre_solve = true});
  ASSERT_TRUE(world.valid(platform));
  const BodyId ball = add_body(world, {0, 0.4}, {.geometry = Circle{0.25}});
  bool holds = true;
  world.on_pre_solve([&](const ContactReading&) { return holds; });
  run(world, 60);
  ASSERT_NEAR(world.position(ball).y, 0.35, 1e-3);
  holds = false;
  run(world, 60);
  EXPECT_NEAR(world.position(ball).y, 0.35 - kGravity / 2, 1e-2);
}

TEST(Contacts, AreReadWithTheirForces) {
  World world(without_sleep());
  const BodyId ground = add_ground(world);
  const BodyId box = add_box(world, {0, 0.5}, 6);
  run(world, 120);
  const auto contacts = world.contacts(box);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(world.contacts(ground).size(), 1u);
  ASSERT_EQ(contacts[0].count, 2);
  const double h = 1.0 / 240;
  EXPECT_NEAR((contacts[0].impulses[0] + contacts[0].impulses[1]) / h, 6 * kGravity, 0x1p-22 * 6 * kGravity);
  EXPECT_NEAR(std::abs(contacts[0].points[0].x - contacts[0].points[1].x), 1, 0x1p-22);
  EXPECT_NEAR(contacts[0].points[0].y, 0, 0x1p-22);
}

// If hundreds fall side by side and a few meet, the pairs are found at once: the few bounce as if alone.
TEST(Contacts, TheFewThatMeetAmongManyThatFall) {
  const ShapeDefinition disc{.geometry = Circle{0.5}, .material = {.friction = 0, .restitution = 1}};
  World world({.gravity = {0, -kGravity}});
  std::vector<BodyId> discs;
  for (int i = 0; i < 400; ++i)
    discs.push_back(add_body(world, {3.0 * (i / 20), 3.0 * (i % 20)}, disc, {i % 50 == 7 ? 2.0 : 0.0, 0}));
  BodyDefinition kinematic;  // and one below the last column
  kinematic.type = BodyType::Kinematic;
  kinematic.position = {57, -3.5};
  world.create_body(kinematic, ShapeDefinition{.geometry = Box{2, 2}});
  run(world, 90);  // those that fly aside reach the next ones after 1 s, 2 m away
  for (int i = 0; i < 380; ++i) {
    const bool was_struck = i >= 20 && (i - 20) % 50 == 7;
    EXPECT_NEAR(world.velocity(discs[i]).x, was_struck ? 2 : 0, 1e-5) << i;
    EXPECT_NEAR(world.velocity(discs[i]).y, -1.5 * kGravity, 1e-4) << i;
  }
  // Equal discs of restitution 1 swap their velocities, as if points went through each other and bounced off
  // the kinematic body alone, 2 m apart. The lowest now is the one that began 12 m above it and has yet to
  // land.
  EXPECT_NEAR(world.position(discs[380]).y, -2 + 12 - kGravity * 1.5 * 1.5 / 2, 1e-3) << "it was thrown back";
  EXPECT_NEAR(world.velocity(discs[380]).y, -1.5 * kGravity, 1e-3);
}

// Points are kept while bodies turn together; their normal has to turn with them.
TEST(Manifolds, TheNormalOfBodiesThatTurnTogetherTurnsWithThem) {
  World world(weightless());
  constexpr double kSpin = 0.5, kArm = 1.55;  // rad/s, m
  const BodyId drum = world.create_body({.type = BodyType::Kinematic, .angular_velocity = kSpin},
                                        ShapeDefinition{.geometry = Box{4, 0.4}, .position = {0, -2}});
  const BodyId box = add_body(world, {0, -kArm}, {.geometry = Box{0.5, 0.5}}, {kSpin * kArm, 0});
  world.set_angular_velocity(box, kSpin);
  for (int step = 0; step < 400; ++step) {
    world.step(1.0 / 60);
    const std::vector<ContactReading> contacts = world.contacts(box);
    ASSERT_EQ(contacts.size(), 1) << step;
    // A step's contact is that of its middle, by which the drum has turned kSpin / 120 since. Recycles while
    // the bodies move relative to each other by less than 0.2 % of the smaller extent: the normal is off by
    // less than 0.002 rad, as its arm is longer than that extent.
    const double angle = world.angle(drum) - kSpin / 120;
    EXPECT_NEAR(cross({-std::sin(angle), std::cos(angle)}, contacts[0].normal), 0, 0.002) << step;
  }
}

}  // namespace
}  // namespace plumb
