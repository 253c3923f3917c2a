#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/scene/error.h"
#include "tests/precise/contact_scenes.h"
#include "tests/precise/truth.h"

namespace plumb {
namespace {

using truth::Real;

TEST(PreciseRest, BouncingEndsAtItsLimitTime) {
  // T = sqrt(2 h/g) (1 + e)/(1 - e).
  for (const double e : {0.8, 0.5, 0.2, 0.95}) {
    for (const bool is_disc : {true, false}) {
      Scene scene{.name = "bounce"};
      scene.bodies = {ground(0.3, e), is_disc ? disc("body", {0, 1.5}, {}, 0.5, 0.3, e)
                                              : block("body", {0, 1.25}, 1, 0.5, 0.3, e)};
      const auto driver = make_precise_driver(scene, {}, {});
      const Real limit = std::sqrt(2 / 9.81L) * (1 + static_cast<Real>(e)) / (1 - static_cast<Real>(e));
      const int steps = static_cast<int>(std::ceil(60 * static_cast<double>(limit))) + 1;
      const auto s = advance(*driver, 2, steps);
      EXPECT_EQ(events(*driver, ContactEvent::Rest).count, 1) << e;
      EXPECT_NEAR(events(*driver, ContactEvent::Rest).last, static_cast<double>(limit), 4e-10) << e;
      EXPECT_NEAR(s[1].position.y, is_disc ? 0.5 : 0.25, 1e-14);
      EXPECT_NEAR(s[1].velocity.y, 0, 1e-14);
      EXPECT_NEAR(s[1].angle, 0, 1e-13) << "both corners at once";
      EXPECT_NEAR(s[1].position.x, 0, 1e-13);
    }
  }
}

TEST(PreciseRest, BouncesAsideWithFrictionAllTheWay) {
  // A block that slips all the while: dv_x = -mu dv_n over every impact, and mu g at rest: in all mu g t from
  // the start of the fall on, counted from the first impact with the speed sqrt(2 g h).
  const double mu = 0.1, e = 0.5, g = 9.81;
  Scene scene{.name = "aside"};
  scene.bodies = {ground(mu, e), block("body", {0, 1}, 1, 0.5, mu, e)};
  scene.bodies[1].velocity = {6, 0};
  scene.bodies[1].fixed_rotation = true;
  const auto s = run(scene, 120);
  EXPECT_NEAR(s[1].velocity.x, 6 - mu * g * 2, 1e-12);
}

TEST(PreciseRest, StacksStand) {
  Scene scene{.name = "stack"};
  scene.bodies = {ground(0.5)};
  for (int i = 0; i < 6; ++i) {
    scene.bodies.push_back(block("block" + std::to_string(i), {0.01 * (i % 2), 0.25 + 0.5 * i}, 1, 0.5, 0.5));
    scene.bodies.back().mass = i == 5 ? 100 : 1;
  }
  const auto driver = make_precise_driver(scene, {}, {});
  const auto s = advance(*driver, 7, 300);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(s[i + 1].position.x, 0.01 * (i % 2), 1e-13);
    EXPECT_NEAR(s[i + 1].position.y, 0.25 + 0.5 * i, 1e-14);
    EXPECT_NEAR(s[i + 1].angle, 0, 1e-13);
  }
  EXPECT_EQ(events(*driver, ContactEvent::Separation).count, 0);
}

/// A pyramid of boxes of 1 m and 1 kg, each on the edges of two below it.
Scene pyramid(int rows) {
  Scene scene{.name = "pyramid"};
  scene.bodies = {ground(0.6)};
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < rows - row; ++i) {
      const Vec2d place{1.01 * (i - (rows - row - 1) / 2.0), row + 0.5};
      scene.bodies.push_back(block("block" + std::to_string(scene.bodies.size()), place, 1, 1, 0.6));
      scene.bodies.back().mass = 1;
    }
  return scene;
}

TEST(PreciseRest, PyramidsWithMoreContactsThanStaticsDeterminesStandWithoutEvents) {
  for (const int rows : {2, 3, 4, 5, 7}) {
    const Scene scene = pyramid(rows);
    const auto driver = make_precise_driver(scene, {}, {});
    const auto states = advance(*driver, scene.bodies.size(), 30);
    double largest = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      largest = std::max(largest, length_squared(states[i].position - scene.bodies[i].position));
    EXPECT_LT(std::sqrt(largest), 1e-13) << rows;
    EXPECT_EQ(events(*driver, ContactEvent::Separation).count, 0) << rows;
    EXPECT_EQ(events(*driver, ContactEvent::SlipStart).count, 0) << rows;
    Vec2d carried{};
    for (const ContactReaction& contact : driver->reactions().contacts) {
      // Every contact pushes, and the ground, the first body, carries the whole weight.
      EXPECT_GE(contact.normal_force, -1e-9) << rows;
      const Vec2d tangent{-contact.normal.y, contact.normal.x};
      if (contact.body_a == 0)
        carried += contact.normal_force * contact.normal + contact.tangent_force * tangent;
    }
    EXPECT_NEAR(carried.y, 9.81 * rows * (rows + 1) / 2, 1e-9) << rows;
    EXPECT_NEAR(carried.x, 0, 1e-9) << rows;
  }
}

TEST(PreciseRest, OnMoreSupportsThanAreNeeded) {
  // A long box on four posts: normal forces are not determined, the motion is.
  Scene scene{.name = "posts"};
  for (const double x : {-2.0, -1.0, 1.5, 2.0}) {
    Body post = block("post" + std::to_string(scene.bodies.size()), {x, -0.5}, 0.3, 1, 0.5);
    post.type = BodyType::Static;
    scene.bodies.push_back(post);
  }
  scene.bodies.push_back(block("beam", {0, 0.1}, 5, 0.2, 0.5));
  scene.forces = {PointForce{"beam", {1, 0}, {1, 0.1}}};  // pulled, not hard enough
  const auto s = run(scene, 120);
  EXPECT_NEAR(s[4].position.x, 0, 1e-13);
  EXPECT_NEAR(s[4].position.y, 0.1, 1e-14);
  EXPECT_NEAR(s[4].angle, 0, 1e-14);
}

TEST(PreciseRest, RockingDiesOut) {
  // A block let go on one corner rocks to rest in finite time: both corners down, level.
  const double angle = 0.2, c = std::cos(angle), si = std::sin(angle);
  Scene scene{.name = "rock"};
  scene.bodies = {ground(0.9), block("block", {0, 0.2 * si + 0.5 * c}, 0.4, 1, 0.9)};
  scene.bodies[1].angle = angle;
  const auto driver = make_precise_driver(scene, {}, {});
  const auto s = advance(*driver, 2, 180);
  EXPECT_NEAR(s[1].angle, 0, 1e-13);
  EXPECT_NEAR(s[1].position.y, 0.5, 1e-14);
  EXPECT_NEAR(s[1].angular_velocity, 0, 1e-14);
  EXPECT_GT(events(*driver, ContactEvent::Impact).count, 10);
  EXPECT_LT(events(*driver, ContactEvent::Impact).count, 200);
}

TEST(PreciseRest, PilesSettle) {
  Scene scene{.name = "pile"};
  scene.bodies = {ground(0.5, 0.2)};
  for (int i = 0; i < 8; ++i) {
    Body body = i % 3 == 2 ? disc("body" + std::to_string(i), {}, {}, 0.3, 0.5, 0.2)
                           : block("body" + std::to_string(i), {}, 0.6 + 0.03 * i, 0.5, 0.5, 0.2);
    body.position = {0.13 * (i % 4) - 0.05 * i, 0.6 + 0.8 * i};
    body.angle = 0.1 * i;
    scene.bodies.push_back(body);
  }
  const auto driver = make_precise_driver(scene, {}, {});
  const auto s = advance(*driver, 9, 360);
  for (int i = 1; i < 9; ++i) {
    EXPECT_GT(s[i].position.y, 0.2) << i;
    EXPECT_LT(std::abs(s[i].position.x), 50) << i;
  }
}

TEST(PreciseRest, JointedBodiesComeToRestOnTheGround) {
  // Three rods from a hinge above fall on the ground and lie there; hinges stay closed.
  Scene scene = rods(3);
  for (Body& body : scene.bodies) {
    body.shapes = {{.geometry = Box{1, 0.1}, .friction = 0.4, .restitution = 0.1}};
    body.shapes[0].filter.group = -1;
  }
  Body floor = block("floor", {0, -2.1}, 20, 1, 0.4);
  floor.type = BodyType::Static;
  scene.bodies.push_back(floor);
  const auto driver = make_precise_driver(scene, {}, {});
  auto s = advance(*driver, 4, 300);
  const double last = s[2].position.x;
  s = advance(*driver, 4, 120);
  EXPECT_NEAR(s[2].position.x, last, 1e-12);
  EXPECT_NEAR(s[2].position.y, -1.55, 1e-13);
  s.pop_back();
  EXPECT_LT(check_rods(s).gap, 1e-13);
  EXPECT_LT(check_rods(s).kinetic, 1e-24);
}

TEST(PreciseRest, TooManyContactsAreRefusedBeforeTheyStart) {
  Scene scene{.name = "many"};
  scene.bodies = {ground(0.5)};
  for (int i = 0; i < 301; ++i)
    scene.bodies.push_back(block("b" + std::to_string(i), {0, 1.0 + i}, 1, 1, 0.5));
  const std::string reason = precise_unsupported(scene);
  EXPECT_NE(reason.find("301"), std::string::npos) << reason;
  EXPECT_NE(reason.find("Realtime{"), std::string::npos) << reason;
  scene.bodies.pop_back();
  EXPECT_EQ(precise_unsupported(scene), "");
}

TEST(PreciseRest, SavedAmidContactsAndRestored) {
  Scene scene{.name = "saved"};
  scene.bodies = {ground(0.2), disc("disc", {0, 0.5}, {5, 0}, 0.5, 0.2),
                  block("block", {3, 0.8}, 1, 0.5, 0.2, 0.3)};
  const auto driver = make_precise_driver(scene, {}, {});
  advance(*driver, 3, 25);
  const auto snapshot = driver->save();
  const auto straight = advance(*driver, 3, 60);
  const auto other = make_precise_driver(scene, {}, {});
  other->restore(snapshot);
  EXPECT_EQ(advance(*other, 3, 60), straight);
  EXPECT_EQ(other->save(), driver->save());
}

}  // namespace
}  // namespace plumb
