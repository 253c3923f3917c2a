// Joints in the rivals, and what they cannot do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/math/trigonometry.h"
#include "reference/backend.h"
#include "tests/reference/scenes.h"

namespace plumb::reference {
namespace {

using namespace plumb::reference::testing;
using ::testing::HasSubstr;

constexpr double kGravity = 9.81;

Vec2d anchor_in_world(const BodyState& state, Vec2d anchor) {
  return state.position + rotation_of(state.angle) * anchor;
}

/// Largest |C| over a run, C given by `gap`.
template <class Gap>
double largest_gap(const Backend& engine, const Scene& scene, const StepSettings& settings, int steps,
                   const Gap& gap) {
  const auto simulator = engine.create(scene, settings);
  double out = 0;
  simulator->record(steps, 1, scene.bodies.size(), [&](double, std::span<const BodyState> states) {
    out = std::max(out, std::abs(gap(states)));
  });
  return out;
}

class RivalJoints : public ::testing::TestWithParam<const char*> {
 protected:
  const Backend& engine() const { return find_backend(GetParam()); }
};

TEST_P(RivalJoints, APendulumHoldsAndSwings) {
  Scene scene = falling({box("rod", {0.5, 0}, 1, 0.1)});
  scene.bodies[0].inertia = 1.0 / 12;
  scene.joints = {RevoluteJoint{.name = "pin", .body_a = "world", .body_b = "rod", .anchor_b = {-0.5, 0}}};
  // A step moves the rod along its tangent and leaves w^2 h^2 L / 4 of the arc, L/2 the arm and w^2 <= 3 g /
  // L; a fifth of the gap is corrected a step in Bullet, so that five of these add up. Box2D corrects after
  // the step.
  const double h = 1.0 / 240, gap = 5 * 3 * kGravity * h * h / 4;
  EXPECT_LT(largest_gap(engine(), scene, steps_of(4 * h, 4), 180,
                        [](auto states) {
                          return length(anchor_in_world(states[0], {-0.5, 0}));
                        }),
            gap);
  // T = 1.18034059901610 * 2 pi sqrt(2 L / (3 g)) from 90 degrees: half of it brings the rod to the other
  // side. The error is of first order; at 90 degrees the angular acceleration is 1.5 g / L.
  const double half = 1.18034059901610 * M_PI * std::sqrt(2 / (3 * kGravity)), fine = half / 2000;
  const BodyState rod = run(engine(), scene, half, steps_of(fine))[0];
  EXPECT_NEAR(rod.angle, -M_PI, 0.01);
  EXPECT_NEAR(rod.angular_velocity, 0, 1.5 * kGravity * 3 * fine);
}

TEST_P(RivalJoints, ADistanceJointIsARigidRod) {
  // A disc on a rod of 1 m about the world's (0, 2), with an anchor off its centre.
  Scene scene = falling({disc("bob", {1, 2}, 0.2)});
  scene.joints = {DistanceJoint{.name = "rod",
                                .body_a = "bob",
                                .body_b = "world",
                                .anchor_a = {-0.1, 0},
                                .anchor_b = {0, 2},
                                .length = 0.9}};
  const double h = 1.0 / 240,
               gap = 5 * 3 * kGravity * h * h;  // as above, with the centripetal 3 g at the most
  EXPECT_LT(largest_gap(engine(), scene, steps_of(4 * h, 4), 180,
                        [](auto states) {
                          return length(anchor_in_world(states[0], {-0.1, 0}) - Vec2d{0, 2}) - 0.9;
                        }),
            gap);
  // Pulled and pushed: between two bodies the rod keeps its length and the momentum its value.
  scene = weightless({disc("a", {}), moving(disc("b", {3, 0}, 0.5, 2), {-1, 0})});
  scene.joints = {DistanceJoint{.name = "rod", .body_a = "a", .body_b = "b", .length = 3}};
  const auto states = run(engine(), scene, 3, steps_of(0.01));
  const double tolerance = 4 * epsilon_of(engine());
  EXPECT_NEAR(states[0].velocity.x, -2.0 / 3, tolerance);
  EXPECT_NEAR(states[1].velocity.x, -2.0 / 3, tolerance);
  EXPECT_NEAR(states[1].position.x - states[0].position.x, 3, 3 * tolerance);
}

TEST_P(RivalJoints, JoinedBodiesTouchOnlyWhereTheJointSaysSo) {
  // A disc swings about a pin on a block and, at the bottom of its arc, into the block's flank.
  Scene scene = falling({of_type(box("block", {0, -1}, 1, 1), BodyType::Static), disc("bob", {1, 0}, 0.2)});
  RevoluteJoint pin{
      .name = "pin", .body_a = "block", .body_b = "bob", .anchor_a = {0, 1}, .anchor_b = {-1, 0}};
  for (const bool collide : {false, true}) {
    pin.collide = collide;
    scene.joints = {pin};
    const auto simulator = engine().create(scene, steps_of(1.0 / 60, 4));
    double least = 1;
    simulator->record(90, 1, 2, [&](double, auto states) { least = std::min(least, states[1].position.x); });
    if (collide) {
      EXPECT_GT(least, 0.6);  // the flank is at 0.5, the radius 0.2
    } else {
      EXPECT_LT(least, -0.9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RivalJoints, ::testing::Values("box2d", "bullet", "bullet-double"),
                         [](const auto& each) {
                           return std::string(each.param).substr(0, 6) +
                                  (std::string(each.param).size() > 6 ? "Double" : "");
                         });

TEST(Unsupported, NamesWhatIsBeyondAnEngine) {
  const auto reason = [](const char* engine, const Scene& scene) {
    return find_backend(engine).unsupported(scene, {});
  };
  Scene scene = falling({disc("bob", {1, 2}, 0.2)});
  for (const char* engine : {"box2d", "bullet", "bullet-double"}) EXPECT_EQ(reason(engine, scene), "");

  scene.joints = {DistanceJoint{.name = "rod", .body_a = "bob", .body_b = "world", .length = 0.004}};
  EXPECT_THAT(reason("box2d", scene), HasSubstr("joint 'rod': length 0.004 m is below Box2D's least"));
  EXPECT_EQ(reason("bullet", scene), "");

  scene.bodies[0].mass = 1e7;
  EXPECT_THAT(reason("bullet", scene), HasSubstr("joint 'rod': its bodies are too heavy"));
  EXPECT_EQ(reason("bullet-double", scene), "");

  scene = falling({disc("bob", {1e30, 2}, 0.2)});
  EXPECT_THAT(reason("box2d", scene), HasSubstr("body 'bob': position 1e+30 is beyond the range"));
  EXPECT_THAT(reason("bullet", scene), HasSubstr("body 'bob': position 1e+30 is beyond the range"));
  EXPECT_EQ(reason("bullet-double", scene), "");

  scene = falling({disc("bob", {}, 1e-20), disc("speck", {}, 1, 1e-30)});
  EXPECT_THAT(reason("box2d", scene), HasSubstr("body 'bob': "));
  scene.bodies.erase(scene.bodies.begin());
  EXPECT_THAT(reason("bullet", scene), HasSubstr("body 'speck': mass 1e-30"));
}

TEST(Unsupported, WhatIsSupportedNeverAborts) {
  // Box2D is built with its assertions on: the edges of what is let through must run.
  Scene scene = falling({disc("dot", {}, 1e-17, 1e-17), box("sliver", {3, 0}, 1e-9, 1e-9, 1e12),
                         disc("far", {1e17, -1e17}), moving(disc("fast", {9, 9}), {1e17, 0}, 1e17)});
  scene.bodies[0].inertia = 1e-17;
  scene.bodies[1].inertia = 1e12;
  for (const char* engine : {"box2d", "bullet", "bullet-double"}) {
    ASSERT_EQ(find_backend(engine).unsupported(scene, {}), "") << engine;
    const auto simulator = find_backend(engine).create(scene, steps_of(0.01));
    EXPECT_GE(simulator->advance(10), 0) << engine;
  }
}

}  // namespace
}  // namespace plumb::reference
