#include <gtest/gtest.h>

#include <cmath>

#include "engine/world/queries.h"
#include "tests/world/mover_scene.h"
#include "tests/world/query_truth.h"

namespace plumb {
namespace {

template <class Real>
class MoverAmongBodies : public MoverScene<Real> {};

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(MoverAmongBodies, Reals);

TYPED_TEST(MoverAmongBodies, IsCarriedByPlatforms) {
  for (const Vec2d speed : {Vec2d{2, 0}, Vec2d{0, 1}, Vec2d{0, -1}, Vec2d{-3, 1}, Vec2d{1, -8}}) {
    SCOPED_TRACE(testing::Message() << speed.x << ", " << speed.y);
    this->world = BasicWorld<TypeParam>();
    const BodyId platform = this->add_platform({0, 0}, speed);
    this->place({0.5, 0.5 + kSkin});
    this->now.on_ground = true;
    EXPECT_TRUE(this->walk(60, 0));
    const Vec2d on_it = this->now.position - this->world.position(platform);
    EXPECT_NEAR(on_it.x, 0.5, 10 * this->kTolerance);
    EXPECT_NEAR(on_it.y, 0.5 + kSkin, 10 * this->kTolerance);
    EXPECT_NEAR(this->now.ground_velocity.x, speed.x, this->kTolerance);
    // Its speed is relative to the platform.
    EXPECT_TRUE(this->walk(30, 2));
    EXPECT_NEAR(this->now.position.x - this->world.position(platform).x, 1.5, 10 * this->kTolerance);
  }
}

TYPED_TEST(MoverAmongBodies, IsCarriedRoundByWhatTurns) {
  const double spin = 0.2;
  const BodyId platform = this->add_platform({0, 0}, {0, 0}, spin, {20, 1});
  this->place({5, 0.5 + kSkin});
  this->now.on_ground = true;
  EXPECT_TRUE(this->walk(60, 0));
  // The point below its round end goes round with the platform.
  const Vec2d normal = this->now.ground_normal;
  const Vec2d foot = this->now.position + Vec2d{0, kRadius} - (kRadius + kSkin) * normal;
  const Vec2d local = this->world.local_point(platform, foot);
  EXPECT_NEAR(local.y, 0.5, 20 * kDt * kDt * spin);
  // It does not turn itself: its round end rolls on.
  EXPECT_NEAR(local.x, 5 + kRadius * spin, 1e-3);
}

TYPED_TEST(MoverAmongBodies, IsCarriedByAMovingSurface) {
  this->world.create_body({.type = BodyType::Static, .position = {0, -1}},
                          ShapeDefinition{.geometry = Box{100, 2}, .material = {.surface_speed = 3}});
  this->place({0, kSkin});
  this->now.on_ground = true;
  EXPECT_TRUE(this->walk(60, -1));
  EXPECT_NEAR(this->now.position.x, 2, this->kTolerance);
}

TYPED_TEST(MoverAmongBodies, TakesThePlatformsVelocityWhenItJumps) {
  const BodyId platform = this->add_platform({0, 0}, {3, 1});
  this->place({0, 0.5 + kSkin});
  this->now.on_ground = true;
  this->walk(10, 0);
  const MoverResult jump = move(this->world, kPerson, this->now.position, {1, 5}, kDt, this->options);
  EXPECT_FALSE(jump.on_ground);
  EXPECT_NEAR(jump.velocity.x, 4, this->kTolerance);
  EXPECT_NEAR(jump.velocity.y, 6, this->kTolerance);
  // Whoever lands on it with its velocity stands still on it.
  MoverResult land{.position = this->world.position(platform) + Vec2d{0, 0.8}, .velocity = {3, -5}};
  for (int i = 0; i < 20 && !land.on_ground; ++i) {
    land = move(this->world, kPerson, land.position, land.velocity, kDt, this->options);
    this->world.step(kDt);
  }
  ASSERT_TRUE(land.on_ground);
  EXPECT_NEAR(land.velocity.x, 0, this->kTolerance);
}

TYPED_TEST(MoverAmongBodies, IsPushedByWhatMovesIntoIt) {
  this->add_floor();
  const BodyId door = this->add_platform({-3, 1.5}, {2, 0}, 0, {1, 2.8});
  this->place({0, kSkin});
  this->now.on_ground = true;
  for (int i = 0; i < 120; ++i) {
    this->frame(0);
    EXPECT_FALSE(this->now.squeezed);
    const double face = this->world.position(door).x + 0.5;
    EXPECT_GT(this->now.position.x - kRadius, face - 2 * kDt - 1e-5);
  }
  EXPECT_NEAR(this->world.position(door).x, 1, 1e-5);
  EXPECT_GT(this->now.position.x, 1.5 + kRadius - 2 * kDt - 1e-5);
}

TYPED_TEST(MoverAmongBodies, IsNotSqueezedThroughAWall) {
  this->add_floor();
  this->add_static(Box{0.01, 10}, {2, 5});
  this->add_platform({-3, 1.5}, {5, 0}, 0, {1, 2.8});
  this->place({0, kSkin});
  this->now.on_ground = true;
  bool squeezed = false;
  for (int i = 0; i < 90; ++i) {
    this->frame(0);
    squeezed = squeezed || this->now.squeezed;
    ASSERT_LT(this->now.position.x + kRadius, 2 - 0.005 + 1e-9);
    ASSERT_GT(this->now.position.y, 0);
  }
  EXPECT_TRUE(squeezed);
}

TYPED_TEST(MoverAmongBodies, StaysInARoomWhateverHappensThere) {
  query_truth::Random random(5);
  const double half = 6, thin = 0.05;
  for (const double side : {-1.0, 1.0}) {
    this->add_static(Box{2 * half + 1, thin}, {0, side * half});
    this->add_static(Box{thin, 2 * half + 1}, {side * half, 0});
  }
  for (int i = 0; i < 6; ++i) {
    this->add_platform(random.within(4), random.within(2), random.uniform(-4, 4), {4, 0.5});
  }
  for (int i = 0; i < 30; ++i) {
    this->world.create_body({.position = random.within(5), .velocity = random.within(10)},
                            ShapeDefinition{.geometry = query_truth::random_geometry(random)});
  }
  this->place({0, 0});
  this->options.mass = 80;
  this->options.push_force = 2000;
  int squeezed = 0, stood = 0;
  for (int i = 0; i < 3000; ++i) {
    for (const BodyId body : this->world.bodies()) {  // moving bodies stay inside
      if (this->world.type(body) != BodyType::Kinematic) continue;
      const Vec2d at = this->world.position(body), v = this->world.velocity(body);
      if (length_squared(at) > 20 && dot(at, v) > 0) this->world.set_velocity(body, -v);
    }
    if (i % 20 == 0) this->now.velocity = random.within(i % 100 == 0 ? 1e3 : 10);
    this->frame(random.uniform(-6, 6));
    squeezed += this->now.squeezed, stood += this->now.on_ground;
    const Vec2d at = this->now.position;
    ASSERT_LT(std::abs(at.x) + kRadius, half - thin / 2 + this->kTolerance) << "frame " << i;
    ASSERT_LT(at.y + 1.5 + kRadius, half - thin / 2 + this->kTolerance) << "frame " << i;
    ASSERT_GT(at.y, -half + thin / 2 - this->kTolerance) << "frame " << i;
  }
  EXPECT_GT(squeezed, 10);
  EXPECT_GT(stood, 100);
}

TYPED_TEST(MoverAmongBodies, PushesCratesWithABoundedImpulse) {
  this->world.set_gravity({});
  const BodyId crate =
      this->world.create_body({.position = {1, 1}}, ShapeDefinition{.geometry = Box{1, 2}, .density = 10});
  const Vec2d start{0.5 - kRadius - 2 * kSkin, 0.2};
  // Inelastic: 80 kg at 2 m/s against 20 kg at rest.
  this->options.mass = 80;
  MoverResult hit = move(this->world, kPerson, start, {2, 0}, kDt, this->options);
  ASSERT_EQ(hit.hits.size(), 1u);
  EXPECT_EQ(hit.hits[0].body, crate);
  const double lever = hit.hits[0].point.y - 1, inertia = 20 * (1 + 4) / 12.0;
  const double gives = 1 / 20.0 + lever * lever / inertia;
  EXPECT_NEAR(hit.hits[0].impulse, 2 / (1 / 80.0 + gives), 1e-4);
  // Neither a stronger push than allowed, nor any without mass.
  this->options.push_force = 60;
  hit = move(this->world, kPerson, start, {2, 0}, kDt, this->options);
  EXPECT_NEAR(hit.hits[0].impulse, 60 * kDt, 1e-9);
  apply_pushes(this->world, hit);
  EXPECT_NEAR(this->world.velocity(crate).x, 60 * kDt / 20, 1e-6);
  this->options.mass = 0;
  EXPECT_EQ(move(this->world, kPerson, start, {2, 0}, kDt, this->options).hits[0].impulse, 0);
}

TYPED_TEST(MoverAmongBodies, PushesACrateAhead) {
  this->add_floor();
  const BodyId crate = this->world.create_body(
      {.position = {2, 0.5}, .lock_rotation = true},
      ShapeDefinition{.geometry = Box{1, 1}, .density = 10, .material = {.friction = 0}});
  this->options.mass = 80;
  this->place({0, kSkin});
  this->now.on_ground = true;
  EXPECT_TRUE(this->walk(180, 2));
  // Both go on at its walking speed, and it does not fall behind by more than a step's way.
  EXPECT_NEAR(this->world.velocity(crate).x, 2, 1e-3);
  EXPECT_NEAR(this->now.position.x + kRadius, this->world.position(crate).x - 0.5, 2 * 2 * kDt);
  EXPECT_NEAR(this->world.position(crate).x - 2, 2 * (3 - (1.5 - kRadius) / 2), 0.1);
}

TYPED_TEST(MoverAmongBodies, StandsOnACrate) {
  this->add_floor();
  this->world.create_body({.position = {0, 0.5}}, ShapeDefinition{.geometry = Box{2, 1}, .density = 100});
  this->options.mass = 80;
  this->place({0.3, 1.2});
  this->walk(60, 0);
  const Vec2d here = this->now.position;
  EXPECT_NEAR(here.y, 1 + kSkin, 2e-3);  // the crate's contact with the floor is soft
  EXPECT_TRUE(this->walk(120, 0));
  EXPECT_NEAR(this->now.position.x, here.x, 1e-4);
  EXPECT_NEAR(this->now.position.y, here.y, 1e-3);
}

}  // namespace
}  // namespace plumb
