#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/world/support.h"

// Crowds of equal boxes that friction wedges while they collide. Iterations do not converge there within a
// substep, and impulses of an impact act on after it.
namespace plumb {
namespace {

struct Energy {
  double kinetic = 0, total = 0;  // J
};

template <class World>
Energy energy_of(const World& world) {
  Energy sum;
  for (const BodyId body : world.bodies()) {
    if (world.type(body) != BodyType::Dynamic) continue;
    const double spin = world.angular_velocity(body), mass = world.mass(body);
    const double kinetic =
        0.5 * (mass * length_squared(world.velocity(body)) + world.inertia(body) * spin * spin);
    sum.kinetic += kinetic, sum.total += kinetic + 9.81 * mass * world.centre(body).y;
  }
  return sum;
}

// Throws two crowds of 25 boxes at each other in a pit, without restitution, each at about `speed`, m/s.
// Returns the largest gain of energy in a step, relative to the kinetic energy before it.
template <class Real>
double largest_gain(unsigned seed, double speed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) * 0x1p-32;
  };
  BasicWorld<Real> world({.sleeping = false});
  const Material rough{.friction = between(0.85, 1)};
  const auto wall = [&](Vec2d at, double width, double height) {
    world.create_body({.type = BodyType::Static, .position = at},
                      {.geometry = Box{width, height}, .material = rough});
  };
  wall({0, -1}, 80, 2), wall({-15, 6}, 2, 20), wall({15, 6}, 2, 20);
  const double toward = speed * between(0.75, 1.25);
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < 25; ++i)
      world.create_body({.position = {side * (1.2 + 1.7 * (i % 5)) + between(-0.1, 0.1), 0.9 + 1.6 * (i / 5)},
                         .angle = between(-3, 3),
                         .velocity = {-side * toward, between(-0.5, 0) * toward}},
                        {.geometry = Box{1, 1}, .material = rough});
  }
  const double start = energy_of(world).kinetic;
  Energy last = energy_of(world);
  double gain = 0;
  for (int i = 0; i < 90; ++i) {
    world.step();
    const Energy now = energy_of(world);
    if (last.kinetic > 0.02 * start) gain = std::max(gain, (now.total - last.total) / last.kinetic);
    last = now;
  }
  return gain;
}

template <class Real>
class CrowdEnergy : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(CrowdEnergy, Precisions);

// Contacts that push overlaps apart may lift the boxes: by less than 3 % here.
TYPED_TEST(CrowdEnergy, DoesNotGrowWhereFrictionWedgesBoxes) {
  for (const double speed : {9.0, 20.0})
    for (unsigned seed = 1; seed <= 60; ++seed)
      EXPECT_LT(largest_gain<TypeParam>(seed, speed), 0.03) << seed << " at " << speed << " m/s";
}

}  // namespace
}  // namespace plumb
