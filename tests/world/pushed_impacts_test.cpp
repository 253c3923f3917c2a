#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "tests/world/support.h"

// Bodies that forces push while they strike others without restitution: contacts are internal forces, so the
// momentum of all bodies grows by the impulse of the forces, whatever is stopped within a step.
namespace plumb {
namespace {

template <class Real>
class PushedImpacts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(PushedImpacts, Reals);

constexpr double kStep = 1.0 / 60;

template <class Real>
Vec2d momentum_of(const BasicWorld<Real>& world) {
  Vec2d sum{};
  for (const BodyId body : world.bodies()) sum += world.mass(body) * world.velocity(body);
  return sum;
}

// Bound of what rounding changes a momentum by: one unit in the last place for each of 64 operations a step.
template <class Real>
double rounding_of(double momentum, int steps) {
  return 64.0 * steps * std::numeric_limits<Real>::epsilon() * momentum;
}

TYPED_TEST(PushedImpacts, HandOnTheWholePushToTheStruckBody) {
  constexpr double kRadius = 0.1, kForce = 10, kSpeed = 5;
  const ShapeDefinition disc{.geometry = Circle{kRadius},
                             .density = 1 / (std::numbers::pi * kRadius * kRadius)};
  for (int i = 0; i < 100; ++i) {
    BasicWorld<TypeParam> world({.gravity = {0, 0}});
    const BodyId pushed = world.create_body({.position = {-1 - 0.002 * i, 0}, .velocity = {kSpeed, 0}}, disc);
    const BodyId struck = world.create_body({.position = {1, 0}}, disc);
    for (int step = 1; step <= 60; ++step) {
      world.apply_force(pushed, {kForce, 0});
      world.step(kStep);
      const double expected = kSpeed + kForce * kStep * step;
      ASSERT_NEAR(momentum_of(world).x, expected, rounding_of<TypeParam>(expected, step))
          << i << ", step " << step;
    }
    EXPECT_NEAR(world.velocity(struck).x, world.velocity(pushed).x, 1e-3);
  }
}

// Every two bodies attract each other, which adds no momentum; they fly at up to 12 m/s and collide in
// crowds.
TYPED_TEST(PushedImpacts, OfBodiesThatAttractEachOtherKeepTheirMomentum) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 from(seed);
    const auto between = [&](double low, double high) {
      return low + (high - low) * (static_cast<double>(from()) * 0x1p-32);
    };
    BasicWorld<TypeParam> world({.gravity = {0, 0}});
    std::vector<BodyId> bodies;
    double scale = 0;
    for (int i = 0; i < 8; ++i) {
      const double width = between(0.2, 0.8), height = between(0.2, 0.8), x = between(-5, 5),
                   y = between(-5, 5), u = between(-12, 12), v = between(-12, 12);
      const ShapeGeometry kinds[] = {Box{width, height}, Circle{width / 2}};
      bodies.push_back(world.create_body({.position = {x, y}, .velocity = {u, v}},
                                         ShapeDefinition{.geometry = kinds[i % 2]}));
      scale += world.mass(bodies.back()) * 12;
    }
    const Vec2d start = momentum_of(world);
    for (int step = 1; step <= 240; ++step) {
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        for (std::size_t k = i + 1; k < bodies.size(); ++k) {
          const Vec2d way = world.position(bodies[k]) - world.position(bodies[i]);
          const double distance = std::sqrt(length_squared(way));
          const Vec2d force =
              (60 * world.mass(bodies[i]) * world.mass(bodies[k]) / (distance * distance * distance + 0.1)) *
              way;
          world.apply_force(bodies[i], force), world.apply_force(bodies[k], -force);
        }
      }
      world.step(kStep);
      const Vec2d drift = momentum_of(world) - start;
      ASSERT_LT(std::sqrt(length_squared(drift)), rounding_of<TypeParam>(scale, step))
          << "seed " << seed << ", step " << step;
    }
  }
}

// Six discs, of which two overlap by 0.2 mm: their contact pushes them apart while one of them is struck in
// flight and then stopped. Its displacement by the push is not the work of a force.
TYPED_TEST(PushedImpacts, KeepTheMomentumOfDiscsThatAreBeingPushedApart) {
  struct Disc {
    Vec2d position, velocity;
    double spin;
  };
  const Disc discs[] = {
      {{-1.7794661880920157, -1.2402850280286748}, {5.3195099830627441, 3.9697408676147461}, 20.68117904663},
      {{-0.9239543708690352, -0.74409907375335105}, {-3.2247190475463867, 4.3054337501525879}, -6.7281208038},
      {{-0.20351878311463956, -0.1350938939471473},
       {-0.53092467784881592, 1.3468253612518311},
       -1.7606386945},
      {{0.67239891938000829, 0.20762902703416747}, {-0.1029554307460785, 0.3731037080287933}, -0.52745312452},
      {{1.6147704587877201, 0.19324500897158897}, {-0.1065277606248856, -0.8032177090644836}, -1.9693151712},
      {{2.5392495759319735, 0.32186391876637649}, {-0.2851080298423767, 0.6154173612594605}, 5.0473470687},
  };
  BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
  double scale = 0;
  for (const Disc& disc : discs) {
    const BodyId body = world.create_body(
        {.position = disc.position, .velocity = disc.velocity, .angular_velocity = disc.spin},
        {.geometry = Circle{0.471356988}, .material = {.friction = 0, .restitution = 0.148}});
    scale += world.mass(body) * std::sqrt(length_squared(disc.velocity));
  }
  const Vec2d start = momentum_of(world);
  world.step(kStep);
  const Vec2d drift = momentum_of(world) - start;
  EXPECT_LT(std::sqrt(length_squared(drift)), rounding_of<TypeParam>(scale, 1));
}

}  // namespace
}  // namespace plumb
