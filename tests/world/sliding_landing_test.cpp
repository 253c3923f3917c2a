#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/world/support.h"

// Bodies that land on a frictionless wall without gravity. Nothing acts along the wall, so that a body's
// centre keeps its velocity along it, and is where uniform motion takes it, whatever its impacts are.
namespace plumb {
namespace {

constexpr double kDt = 1.0 / 60;
const Material kSmooth{.friction = 0, .restitution = 0};

enum class Wall { Box, Chain };
enum class Body { Box, Polygon, Capsule, Compound };

// Throws random bodies, thin ones among them, at a tilted wall. Returns how many are ever off their place
// along it by more than a hundredth of a step's way.
template <class Real>
int late_bodies(Wall wall, Body body, int count) {
  std::mt19937 generator(5);
  const auto within = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(generator()) / 4294967296.0;
  };
  int late = 0;
  for (int i = 0; i < count; ++i) {
    BasicWorld<Real> world({.gravity = {0, 0}, .sleeping = false});
    const double tilt = within(-3, 3);
    const Vec2d out{std::cos(tilt), std::sin(tilt)}, along{-out.y, out.x};
    if (wall == Wall::Box) {
      world.create_body({.type = BodyType::Static, .position = -out, .angle = tilt},
                        ShapeDefinition{.geometry = plumb::Box{2, 400}, .material = kSmooth});
    } else {
      ChainDefinition chain{.material = kSmooth};
      for (int j = -100; j <= 100; ++j) chain.points.push_back({0, 2.0 * j});
      world.create_chain(world.create_body({.type = BodyType::Static, .angle = tilt}), chain);
    }
    const double width = within(0.05, 1), height = width * std::exp(within(-3, 0));
    const double speed = within(5, 100), slip = within(-100, 100);
    ShapeDefinition shape{.geometry = plumb::Box{width, height}, .material = kSmooth};
    if (body == Body::Capsule) shape.geometry = Capsule{{-0.5 * width, 0}, {0.5 * width, 0}, 0.3 * height};
    if (body == Body::Polygon) {
      plumb::Polygon polygon;
      const int corners = 3 + i % 6;
      for (int j = 0; j < corners; ++j) {
        const double angle = 2 * std::numbers::pi * j / corners + 0.1;
        polygon.points.push_back({0.5 * width * std::cos(angle), 0.5 * height * std::sin(angle)});
      }
      shape.geometry = polygon;
    }
    const BodyId thrown = world.create_body({.position = 1.5 * out,
                                             .angle = tilt + within(-3, 3),
                                             .velocity = -speed * out + slip * along,
                                             .angular_velocity = within(-5, 5)},
                                            shape);
    if (body == Body::Compound)
      world.create_shape(thrown, {.geometry = plumb::Box{height, width},
                                  .position = {0.3 * width, 0.2 * height},
                                  .material = kSmooth});
    const Vec2d start = world.centre(thrown);
    const double rate = dot(world.velocity(thrown), along);
    double off = 0;
    for (int step = 1; step <= 60; ++step) {
      world.step(kDt, 4);
      off = std::max(off, std::abs(dot(world.centre(thrown) - start, along) - rate * kDt * step));
    }
    late += off > 0.01 * std::abs(rate) * kDt;
  }
  return late;
}

template <class Real>
class SlidingLandings : public ::testing::Test {};
using Reals = ::testing::Types<double, float>;
TYPED_TEST_SUITE(SlidingLandings, Reals);

TYPED_TEST(SlidingLandings, OfBoxesCostNoTime) {
  EXPECT_EQ(late_bodies<TypeParam>(Wall::Box, Body::Box, 400), 0);
}

TYPED_TEST(SlidingLandings, OfBoxesOnAChainCostNoTime) {
  EXPECT_EQ(late_bodies<TypeParam>(Wall::Chain, Body::Box, 400), 0);
}

// Those that spin by tens of radians a step may have more impacts in it than are placed at their times: 0 to
// 5 of 400.
TYPED_TEST(SlidingLandings, OfSharpPolygonsAndCapsulesCostNoTimeButFewThatSpin) {
  for (const Wall wall : {Wall::Box, Wall::Chain}) {
    EXPECT_LE(late_bodies<TypeParam>(wall, Body::Polygon, 400), 6);
    EXPECT_LE(late_bodies<TypeParam>(wall, Body::Capsule, 400), 6);
  }
}

// A body of two shapes that land by turns has more impacts in a step than are placed at their times. The last
// of them ends the landing, and the body slides on: stopped there, 27 to 41 of 400 were late.
TYPED_TEST(SlidingLandings, OfTwoBoxesOfABodyCostNoTime) {
  EXPECT_LE(late_bodies<TypeParam>(Wall::Box, Body::Compound, 400), 2);
}

// A corner touches and the other one comes down: the impulse there presses on the first one, so that both
// push.
TYPED_TEST(SlidingLandings, OfASideThatTouchesEndAtOnce) {
  BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
  add_ground(world, kSmooth);
  const BodyId plank =
      world.create_body({.position = {0, 0.05}, .velocity = {25, -2}, .angular_velocity = 4},
                        ShapeDefinition{.geometry = plumb::Box{1, 0.1}, .material = kSmooth});
  for (int step = 1; step <= 6; ++step) {
    world.step(kDt, 4);
    EXPECT_NEAR(world.position(plank).x, 25 * kDt * step, 1e-5) << step;
  }
  EXPECT_NEAR(world.velocity(plank).y, 0, 1e-4);
  EXPECT_NEAR(world.angular_velocity(plank), 0, 1e-4);
  EXPECT_NEAR(world.angle(plank), 0, 1e-3);
}

}  // namespace
}  // namespace plumb
