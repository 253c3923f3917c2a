#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/world/support.h"

// Jointed bodies that rub on what they lie on. Truth is Coulomb's law: a body of any mass slides
// v^2 / (2 mu g) on level ground, rests on a slope below atan mu, and gains g (sin - mu cos) on one above.
namespace plumb {
namespace {

template <class Real>
class JointedFriction : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(JointedFriction, Reals);

constexpr double kStep = 1.0 / 60;
constexpr int kSubsteps = 4;

// Two boxes that a weld joins, side by side on a floor that is turned by `slope`. The second has `ratio`
// times the first one's density.
template <class Real>
struct Pair {
  Pair(double friction, double ratio, double slope, double speed, double surface = 0)
      : world(without_sleep()) {
    const Vec2d along{std::cos(slope), std::sin(slope)}, up{-along.y, along.x};
    const Material material{.friction = friction, .surface_speed = surface};
    world.create_body({.type = BodyType::Static, .position = -1.0 * up, .angle = slope},
                      {.geometry = Box{400, 2}, .material = material});
    const auto box = [&](double at, double density) {
      return world.create_body(
          {.position = at * along + 0.5 * up, .angle = slope, .velocity = speed * along},
          {.geometry = Box{1, 1}, .density = density, .material = {.friction = friction}});
    };
    first = box(0, 1), second = box(1, ratio);
    world.create_joint(first, second, {.kind = WeldDefinition{.anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}}});
    direction = along, start = world.position(first);
  }
  double way() const { return dot(world.position(first) - start, direction); }
  double lift() const { return dot(world.position(first) - start, {-direction.y, direction.x}); }

  BasicWorld<Real> world;
  BodyId first, second;
  Vec2d direction{}, start{};
};

// A step takes its friction at the speed of one of its ends: the way is exact to half a substep's way.
TYPED_TEST(JointedFriction, BringsWhatSlidesToRestWhereCoulombSays) {
  for (const double friction : {0.1, 0.3, 0.8}) {
    for (const double ratio : {1.0, 10.0, 1000.0}) {
      const double speed = 3, way = speed * speed / (2 * friction * kGravity);
      Pair<TypeParam> pair(friction, ratio, 0, speed);
      run(pair.world, 300);
      const std::string is =
          "friction " + std::to_string(friction) + ", masses 1 to " + std::to_string(ratio);
      EXPECT_NEAR(pair.way(), way, 0.5 * speed * kStep / kSubsteps) << is;
      EXPECT_NEAR(pair.lift(), 0, 1e-4) << is;
      EXPECT_LT(length(pair.world.velocity(pair.first)), 1e-5) << is;
    }
  }
}

TYPED_TEST(JointedFriction, HoldsOnASlopeBelowItsAngle) {
  for (const double friction : {0.2, 0.6}) {
    for (const double ratio : {1.0, 100.0}) {
      Pair<TypeParam> pair(friction, ratio, -0.98 * std::atan(friction), 0);
      run(pair.world, 300);
      EXPECT_LT(std::abs(pair.way()), 1e-4) << "friction " << friction << ", masses 1 to " << ratio;
    }
  }
}

TYPED_TEST(JointedFriction, LetsSlideBeyondIt) {
  for (const double friction : {0.2, 0.6}) {
    for (const double ratio : {1.0, 100.0}) {
      const double slope = 1.1 * std::atan(friction), time = 2;
      const double gain = kGravity * (std::sin(slope) - friction * std::cos(slope));
      Pair<TypeParam> pair(friction, ratio, -slope, 0);
      run(pair.world, static_cast<int>(std::lround(time / kStep)));
      const double way = 0.5 * gain * time * time;
      EXPECT_NEAR(pair.way(), way, 0.005 * way) << "friction " << friction << ", masses 1 to " << ratio;
      EXPECT_NEAR(pair.lift(), 0, 1e-4) << "friction " << friction << ", masses 1 to " << ratio;
    }
  }
}

// Friction of 5 takes 3 m/s in 0.06 s and tips the pair; what is rougher stops it within a step.
TYPED_TEST(JointedFriction, StopsAtOnceWhatLiesOnAVeryRoughFloor) {
  for (const double friction : {20.0, 1e3, 1e6}) {
    for (const double ratio : {1.0, 100.0}) {
      const double speed = 3;
      Pair<TypeParam> pair(friction, ratio, 0, speed);
      run(pair.world, 200);
      const std::string is =
          "friction " + std::to_string(friction) + ", masses 1 to " + std::to_string(ratio);
      EXPECT_LT(std::abs(pair.way()), speed * kStep) << is;
      EXPECT_NEAR(pair.lift(), 0, 1e-4) << is;
    }
  }
}

TYPED_TEST(JointedFriction, CarriesToTheSpeedOfAConveyor) {
  const double friction = 0.4, surface = 2, time = 0.3;
  Pair<TypeParam> pair(friction, 1, 0, 0, surface);
  run(pair.world, static_cast<int>(std::lround(time / kStep)));
  const double speed = length(pair.world.velocity(pair.first));
  EXPECT_NEAR(speed, friction * kGravity * time, 0.02 * friction * kGravity * time);
  run(pair.world, 120);
  EXPECT_NEAR(length(pair.world.velocity(pair.first)), surface, 1e-4);
}

}  // namespace
}  // namespace plumb
