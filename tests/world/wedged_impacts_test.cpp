#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/world/support.h"

// Impacts that friction wedges between bodies, and loads that friction alone holds: normals and friction must
// be solved together there, at any mass ratio.
namespace plumb {
namespace {

template <class Real>
class WedgedImpacts : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(WedgedImpacts, Precisions);

template <class World>
double energy_of(const World& world) {
  double sum = 0;
  for (const BodyId body : world.bodies()) {
    if (world.type(body) != BodyType::Dynamic) continue;
    const double spin = world.angular_velocity(body), mass = world.mass(body);
    sum += 0.5 * (mass * length_squared(world.velocity(body)) + world.inertia(body) * spin * spin) +
           mass * 9.81 * world.centre(body).y;
  }
  return sum;
}

// Throws a heavy box onto a light one that lies on the ground, without restitution. Returns the largest gain
// of energy in a step, relative to the kinetic energy at the start.
template <class Real>
double largest_gain(unsigned seed, double max_ratio) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) * 0x1p-32;
  };
  BasicWorld<Real> world({.sleeping = false});
  const Material rough{.friction = between(0.5, 1.2)};
  world.create_body({.type = BodyType::Static, .position = {0, -1}},
                    {.geometry = Box{400, 2}, .material = rough});
  const double width = between(0.5, 1), height = between(0.4, 0.8), mass = std::pow(max_ratio, between(0, 1));
  world.create_body({.position = {0, height / 2}},
                    {.geometry = Box{width, height}, .density = 1 / (width * height), .material = rough});
  const double side = between(0.8, 1.6), other = between(0.8, 1.6), speed = between(3, 8);
  const BodyId heavy =
      world.create_body({.position = {between(-1.4, -0.9), height + between(1.15, 1.4)},
                         .angle = between(-0.6, 0.6),
                         .velocity = {between(0.2, 0.8) * speed, -speed},
                         .angular_velocity = between(-4, 4)},
                        {.geometry = Box{side, other}, .density = mass / (side * other), .material = rough});
  const double spin = world.angular_velocity(heavy);
  const double kinetic =
      0.5 * (mass * length_squared(world.velocity(heavy)) + world.inertia(heavy) * spin * spin);
  double last = energy_of(world), gain = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    const double energy = energy_of(world);
    gain = std::max(gain, energy - last), last = energy;
  }
  return gain / kinetic;
}

// Friction and inelastic contacts can only take energy. A step moves bodies along the tangents of their
// turns, which lifts them by up to (w dt)^2 / 2 of their size: below 1 % of the energy. They start apart.
TYPED_TEST(WedgedImpacts, OfHeavyBoxesOnLightOnesGainNoEnergy) {
  for (const double max_ratio : {1.0, 4.0, 300.0, 1e5})
    for (unsigned seed = 0; seed < 60; ++seed)
      EXPECT_LT(largest_gain<TypeParam>(seed, max_ratio), 0.01)
          << "ratio up to " << max_ratio << ", seed " << seed;
}

// Friction holds a box on a slope below its angle, atan(0.6), and what the box carries, however heavy that
// is.
TYPED_TEST(WedgedImpacts, LeaveHeavyLoadsOnLightBoxesOnSlopesAtRest) {
  for (const double ratio : {1e2, 1e3, 1e4}) {
    for (const double share : {0.5, 0.8, 0.95}) {
      BasicWorld<TypeParam> world({.sleeping = false});
      const double angle = share * std::atan(0.6), c = std::cos(angle), s = std::sin(angle);
      const Material rough{.friction = 0.6};
      world.create_body({.type = BodyType::Static, .position = {s, -c}, .angle = angle},
                        {.geometry = Box{100, 2}, .material = rough});
      BodyId boxes[2];
      for (int i = 0; i < 2; ++i) {
        const double up = 0.1 + 0.2 * i;
        boxes[i] =
            world.create_body({.position = {-s * up, c * up}, .angle = angle},
                              {.geometry = Box{2, 0.2}, .density = i == 0 ? 1 : ratio, .material = rough});
      }
      const Vec2d start = world.position(boxes[1]);
      for (int i = 0; i < 300; ++i) world.step();
      EXPECT_LT(length(world.position(boxes[1]) - start), 2e-3) << "ratio " << ratio << ", share " << share;
    }
  }
}

}  // namespace
}  // namespace plumb
