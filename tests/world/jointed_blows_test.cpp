#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/world/support.h"

// Blows on bodies with joints that touch something bouncy. A joint takes up what it forbids of a velocity
// that a game sets, before the rest rebounds, and no impact gains energy.
namespace plumb {
namespace {

constexpr double kPi = 3.14159265358979;
const Solver kSolvers[] = {Solver::SoftSteps, Solver::Direct};

template <class Real>
class JointedBlows : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(JointedBlows, Precisions);

class Dice {
 public:
  explicit Dice(unsigned seed) : dice_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(dice_()) * 0x1p-32;
  }

 private:
  std::mt19937 dice_;
};

template <class World>
double kinetic_energy(const World& world) {
  double sum = 0;
  for (const BodyId body : world.bodies()) {
    if (world.type(body) != BodyType::Dynamic) continue;
    const double spin = world.angular_velocity(body);
    sum +=
        0.5 * (world.mass(body) * length_squared(world.velocity(body)) + world.inertia(body) * spin * spin);
  }
  return sum;
}

// A disc on a rail at an angle to a bouncy floor that it touches gets a blow of 5 m/s into it. Along the rail
// that is 5 sin(angle); the approach that is left rebounds with e times itself, and so along the rail.
TYPED_TEST(JointedBlows, OnADiscOnARailReboundByWhatTheRailLeaves) {
  constexpr double kBlow = 5;
  for (const Solver solver : kSolvers) {
    for (const double angle : {0.03, 0.1, 0.3, 0.6}) {
      for (const double e : {0.0, 0.3, 0.8}) {
        BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
        const BodyId ground = world.create_body({.type = BodyType::Static});
        const Material material{.friction = 0, .restitution = e};
        world.create_body({.type = BodyType::Static},
                          ShapeDefinition{.geometry = Box{4, 1}, .material = material});
        const BodyId disc = world.create_body({.position = {0, 0.9}},
                                              ShapeDefinition{.geometry = Circle{0.4}, .material = material});
        const Vec2d rail{std::cos(angle), std::sin(angle)};
        world.create_joint(ground, disc, {.kind = PrismaticDefinition{.anchor_a = {0, 0.9}, .axis = rail}});
        world.apply_impulse(disc, {0, -kBlow * world.mass(disc)});
        world.step();
        EXPECT_NEAR(dot(world.velocity(disc), rail), e * kBlow * std::sin(angle), 2e-5 * kBlow)
            << static_cast<int>(solver) << " " << angle << " " << e;
      }
    }
  }
}

// Two joined bodies that may collide and overlap, with velocities that their joint forbids. Pushing out an
// overlap may leave up to 4 m/s.
TYPED_TEST(JointedBlows, OnOverlappingJoinedPairsGainNoEnergy) {
  constexpr double kPush = 4;  // m/s
  int pairs = 0;
  for (const Solver solver : kSolvers) {
    for (int kind = 0; kind < 4; ++kind) {
      for (unsigned seed = 0; seed < 60; ++seed) {
        Dice dice(seed);
        BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
        const Material material{.friction = 0.3, .restitution = 0.5};
        const auto add = [&](const ShapeDefinition& shape) {
          BodyDefinition body{.angle = dice.between(-3, 3)};
          body.position = {dice.between(-0.5, 0.5), dice.between(-0.5, 0.5)};
          body.velocity = {dice.between(-5, 5), dice.between(-5, 5)};
          body.angular_velocity = dice.between(-5, 5);
          return world.create_body(body, shape);
        };
        const BodyId box = add({.geometry = Box{0.8, 0.6}, .material = material}),
                     disc = add({.geometry = Circle{0.4}, .material = material});
        const Vec2d at = 0.5 * (world.position(box) + world.position(disc)),
                    apart = world.position(disc) - world.position(box);
        const Vec2d anchor_a = world.local_point(box, at), anchor_b = world.local_point(disc, at);
        const JointKind kinds[] = {
            DistanceDefinition{.length = std::max(length(apart), 0.05)},
            RevoluteDefinition{.anchor_a = anchor_a, .anchor_b = anchor_b},
            WeldDefinition{.anchor_a = anchor_a,
                           .anchor_b = anchor_b,
                           .reference_angle = world.angle(disc) - world.angle(box)},
            PrismaticDefinition{.anchor_a = anchor_a, .anchor_b = anchor_b, .axis = {1, 0}}};
        world.create_joint(box, disc, {.kind = kinds[kind], .collide = true});
        const double before = kinetic_energy(world);
        const double bound = before + 0.5 * (world.mass(box) + world.mass(disc)) * kPush * kPush;
        double most = 0;
        for (int step = 0; step < 40; ++step) {
          world.step();
          ASSERT_TRUE(world.events().quarantined.empty()) << "kind " << kind << ", seed " << seed;
          most = std::max(most, kinetic_energy(world));
        }
        EXPECT_LT(most, bound) << "kind " << kind << ", seed " << seed << ", solver "
                               << static_cast<int>(solver);
        ++pairs;
      }
    }
  }
  EXPECT_EQ(pairs, 480);
}

// A hub with two limbs, whose hinges have limits, falls onto a bouncy floor. The limbs overlap: their impacts
// press the hinges against limits that contradict them.
TYPED_TEST(JointedBlows, OnOverlappingLimbsWithLimitsGainNoEnergy) {
  constexpr double kPush = 4, kFall = 2.5, kGravity = 9.81;
  for (const Solver solver : kSolvers) {
    for (unsigned seed = 0; seed < 25; ++seed) {
      Dice dice(seed);
      BasicWorld<TypeParam> world({.solver = solver});
      const Material material{.friction = 0.5, .restitution = 0.5};
      world.create_body({.type = BodyType::Static, .position = {0, -kFall}},
                        ShapeDefinition{.geometry = Box{20, 1}, .material = material});
      const double reach = dice.between(0.2, 0.6);  // rad
      const BodyId hub =
          world.create_body({}, ShapeDefinition{.geometry = Circle{0.2}, .material = material});
      const auto add_limb = [&](double x) {
        const BodyId limb = world.create_body(
            {.position = {x + dice.between(-0.1, 0.1), -0.4}, .angle = dice.between(-0.4, 0.4)},
            ShapeDefinition{.geometry = Box{0.3, 0.8}, .material = material});
        world.create_joint(hub, limb,
                           {.kind = RevoluteDefinition{.anchor_a = {x, 0},
                                                       .anchor_b = world.local_point(limb, {x, 0}),
                                                       .reference_angle = world.angle(limb),
                                                       .limits = Range{-reach, reach}}});
        return limb;
      };
      const BodyId limbs[] = {add_limb(-0.05), add_limb(0.05)};
      const double mass = world.mass(hub) + world.mass(limbs[0]) + world.mass(limbs[1]);
      const double bound = mass * kGravity * kFall + 0.5 * mass * kPush * kPush;
      for (int step = 0; step < 120; ++step) {
        world.step();
        ASSERT_TRUE(world.events().quarantined.empty()) << seed;
        ASSERT_LT(kinetic_energy(world), bound)
            << "seed " << seed << ", step " << step << ", solver " << static_cast<int>(solver);
      }
    }
  }
}

}  // namespace
}  // namespace plumb
