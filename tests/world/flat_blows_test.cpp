#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tests/world/support.h"

// Bodies that are struck at several places at once. Truth is Newton's law at each place: what approaches at v
// leaves at e v, there and everywhere, so that a bar that falls flat does not turn.
namespace plumb {
namespace {

template <class Real>
class FlatBlows : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(FlatBlows, Reals);

constexpr double kGravity = 9.81, kStep = 1.0 / 60;

// The speed with which a fall of `height` metres ends, and the number of steps in which it does.
double speed_after(double height) { return std::sqrt(2 * kGravity * height); }
int steps_of(double height) { return static_cast<int>(speed_after(height) / kGravity / kStep) + 1; }

// The iterations of a round end when none changes a speed by more than 1e-6 of the fastest. Where one place's
// impulse changes another's speed by a half, as on posts near the middle, ten such changes are still to come.
double iterations_of_spin(double speed, double width) { return 10 * 1e-6 * speed / width; }

TYPED_TEST(FlatBlows, OnTwoPostsDoNotTurnABar) {
  for (const double e : {0.2, 0.5, 1.0}) {
    for (const double friction : {0.0, 0.3}) {
      for (const double left : {0.2, 0.5, 0.9}) {
        for (const double height : {0.1, 0.4, 1.3}) {
          BasicWorld<TypeParam> world({.sleeping = false});
          const Material material{.friction = friction, .restitution = e};
          for (const double x : {-left, 0.6})
            world.create_body({.type = BodyType::Static, .position = {x, -0.5}},
                              {.geometry = Box{0.02, 1}, .material = material});
          const BodyId bar = world.create_body({.position = {0, height + 0.1}, .velocity = {0.2, 0}},
                                               {.geometry = Box{2, 0.2}, .material = material});
          const int steps = steps_of(height);
          for (int i = 0; i < steps; ++i) world.step(kStep);
          const double speed = speed_after(height);
          const std::string is = "e " + std::to_string(e) + ", post " + std::to_string(left) + ", from " +
                                 std::to_string(height) + " m";
          EXPECT_NEAR(world.angular_velocity(bar), 0, iterations_of_spin(speed, 2)) << is;
          // It has been falling again for the rest of the step; substeps place impacts to their own length.
          const double after = e * speed - kGravity * (steps * kStep - speed / kGravity);
          EXPECT_NEAR(world.velocity(bar).y, after, kGravity * kStep / 4) << is;
        }
      }
    }
  }
}

// Friction acts below the centre of mass and would turn the box, were its ends not thrown up at one speed. A
// weight on a rod through the centre of mass turns nothing either.
TYPED_TEST(FlatBlows, WithFrictionDoNotTurnABoxOnARod) {
  for (const double e : {0.3, 0.7, 1.0}) {
    for (const double friction : {0.1, 0.5}) {
      for (const double at : {0.5, 1.2, 2.5}) {
        BasicWorld<TypeParam> world({.sleeping = false});
        const Material material{.friction = friction, .restitution = e};
        world.create_body({.type = BodyType::Static, .position = {0, -0.5}},
                          {.geometry = Box{40, 1}, .material = material});
        constexpr double kHeight = 0.5;
        const Vec2d centre{0, 0.25 + kHeight}, sideways{1.5, 0};
        const BodyId box = world.create_body({.position = centre, .velocity = sideways},
                                             {.geometry = Box{1.6, 0.5}, .material = material});
        const BodyId weight = world.create_body(
            {.position = centre + Vec2d{2 * std::cos(at), 2 * std::sin(at)}, .velocity = sideways},
            {.geometry = Circle{0.1}, .density = 20});
        world.create_joint(box, weight, {.kind = DistanceDefinition{.length = 2}});
        const auto energy = [&] {
          double sum = 0;
          for (const BodyId body : {box, weight}) {
            const Vec2d v = world.velocity(body);
            const double w = world.angular_velocity(body);
            sum += 0.5 * world.mass(body) * length_squared(v) + 0.5 * world.inertia(body) * w * w +
                   kGravity * world.mass(body) * world.position(body).y;
          }
          return sum;
        };
        const double start = energy();
        for (int i = 0; i < steps_of(kHeight); ++i) world.step(kStep);
        const std::string is =
            "e " + std::to_string(e) + ", mu " + std::to_string(friction) + ", rod at " + std::to_string(at);
        EXPECT_NEAR(world.angular_velocity(box), 0, iterations_of_spin(speed_after(kHeight), 1.6)) << is;
        EXPECT_GT(world.velocity(box).y, 0) << is;
        EXPECT_LE(energy(), start * 1.001) << is;
      }
    }
  }
}

// A sleeper that is struck is thrown at what lies beside it within the step. Equal discs exchange their
// speeds: the one that came goes back as fast, whether the other one was awake or not.
TYPED_TEST(FlatBlows, OnSleepersComeBackFromWhatLiesBesideThem) {
  for (const bool asleep : {false, true}) {
    for (const double gap : {0.0005, 0.002, 0.004}) {
      BasicWorld<TypeParam> world({.gravity = {0, 0}});
      const Material material{.friction = 0, .restitution = 1};
      const ShapeDefinition disc{.geometry = Circle{0.5}, .material = material};
      world.create_body({.type = BodyType::Static, .position = {1 + gap, 0}}, disc);
      const BodyId struck = world.create_body({.may_sleep = asleep}, disc);
      for (int i = 0; i < 60; ++i) world.step(kStep);
      ASSERT_EQ(world.awake(struck), !asleep);
      const BodyId comer = world.create_body({.position = {-1.5, 0}, .velocity = {7, 0}}, disc);
      for (int i = 0; i < 20; ++i) world.step(kStep);
      const double rounding = 64 * std::numeric_limits<TypeParam>::epsilon() * 7;
      EXPECT_NEAR(world.velocity(comer).x, -7, rounding) << "gap " << gap << (asleep ? ", asleep" : "");
      EXPECT_NEAR(world.velocity(struck).x, 0, rounding) << "gap " << gap << (asleep ? ", asleep" : "");
    }
  }
}

}  // namespace
}  // namespace plumb
