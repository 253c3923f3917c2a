#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "engine/math/trigonometry.h"
#include "tests/world/support.h"

/// Light links under heavy loads, of all kinds of joints: joints stay within 1 % of a link, and no energy is
/// gained.
namespace plumb {
namespace {

template <class Real>
class HeavyLoads : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(HeavyLoads, Reals);

template <class Real>
double energy_of(const BasicWorld<Real>& world, const std::vector<BodyId>& bodies) {
  double sum = 0;
  for (const BodyId body : bodies) {
    const double m = world.mass(body), w = world.angular_velocity(body);
    sum += m * (0.5 * length_squared(world.velocity(body)) + kGravity * world.centre(body).y) +
           0.5 * world.inertia(body) * w * w;
  }
  return sum;
}

enum class Chain { LimitedHinges, RodsAndHinges, Ropes };

constexpr double kLink = 0.3;  // m

// Returns joint `i` of a chain, of links whose centres are `distance` apart and that are turned by `turn`.
JointKind joint_of(Chain chain, int i, double distance, double turn) {
  const Vec2d end{i == 0 ? 0 : kLink / 2, 0}, start{-kLink / 2, 0};
  if (chain == Chain::Ropes) return DistanceDefinition{.length = distance, .range = Range{0, distance}};
  if (chain == Chain::RodsAndHinges && i % 2 == 1) return DistanceDefinition{.length = distance};
  if (chain == Chain::RodsAndHinges) return RevoluteDefinition{.anchor_a = end, .anchor_b = start};
  return RevoluteDefinition{
      .anchor_a = end, .anchor_b = start, .reference_angle = turn, .limits = Range{-1.2, 1.2}};
}

// Links of 0.3 m and 1 kg, the last one heavy, that swing from a pin. Light links whip: they turn by more
// than a radian in a substep.
TYPED_TEST(HeavyLoads, ChainsHoldAHeavyTip) {
  std::mt19937_64 random(7);
  const auto draw = [&](double a, double b) { return a + (b - a) * double(random() >> 11) * 0x1p-53; };
  for (const Chain chain : {Chain::LimitedHinges, Chain::RodsAndHinges, Chain::Ropes}) {
    for (const double ratio : {1e2, 1e3, 1e4, 1e6}) {
      BasicWorld<TypeParam> world;
      const int links = 3 + static_cast<int>(random() % 7);
      BodyId last = world.create_body({.type = BodyType::Static});
      std::vector<BodyId> bodies;
      std::vector<JointId> joints;
      Vec2d at{}, before{};
      double last_angle = 0, mass = 0;
      const double direction = draw(-2.5, -0.6), spin = draw(-2, 2);
      for (int i = 0; i < links; ++i) {
        const double angle = direction + draw(-0.3, 0.3), m = i + 1 == links ? ratio : 1;
        const Vec2d half = rotation_of(angle) * Vec2d{kLink / 2, 0}, centre = at + half;
        const BodyId link = world.create_body({.position = centre,
                                               .angle = angle,
                                               .velocity = spin * Vec2d{-centre.y, centre.x},
                                               .angular_velocity = spin,
                                               .mass = MassProperties{m, {}, m * kLink * kLink / 12}});
        const double distance = length(centre - before);
        const JointKind kind = joint_of(chain, i, distance, angle - last_angle);
        joints.push_back(world.create_joint(last, link, {.kind = kind}));
        bodies.push_back(link), last = link, before = centre, last_angle = angle;
        at = at + 2. * half, mass += m;
      }
      const double start = energy_of(world, bodies), scale = mass * kGravity * links * kLink;
      double gained = 0, gap = 0;
      for (int step = 0; step < 240; ++step) {
        world.step(1.0 / 60, 4);
        gained = std::max(gained, (energy_of(world, bodies) - start) / scale);
        for (const JointId joint : joints)
          gap = std::max(gap, double(world.read(joint).linear_error) / kLink);
      }
      EXPECT_LT(gained, 2e-3) << static_cast<int>(chain) << ", " << links << " links, 1:" << ratio;
      EXPECT_LT(gap, 0.01) << static_cast<int>(chain) << ", " << links << " links, 1:" << ratio;
    }
  }
}

// A straight bridge of hinged planks between two pins, with a load laid on its middle, or dropped beside it
// from 2 m. It can carry the load only once it sags, as its planks cannot stretch.
enum class Load { LaidCrate, DroppedBall };

TYPED_TEST(HeavyLoads, TautBridgesCarryThem) {
  for (const Solver solver : {Solver::SoftSteps, Solver::Direct}) {
    for (const Load load : {Load::LaidCrate, Load::DroppedBall}) {
      for (const int planks : {5, 12, 24, 40}) {
        for (const double ratio : {30.0, 300.0, 1e4}) {
          BasicWorld<TypeParam> world({.solver = solver});
          const BodyId ground = world.create_body({.type = BodyType::Static});
          BodyId last = ground;
          std::vector<BodyId> bodies;
          std::vector<JointId> joints;
          const auto hinge = [&](BodyId a, BodyId b, Vec2d at_a, Vec2d at_b) {
            joints.push_back(
                world.create_joint(a, b, {.kind = RevoluteDefinition{.anchor_a = at_a, .anchor_b = at_b}}));
          };
          for (int i = 0; i < planks; ++i) {
            const BodyId plank =
                world.create_body({.position = {i + 0.5, 0}}, {.geometry = Box{0.96, 0.2}, .density = 2});
            hinge(last, plank, {i == 0 ? 0 : 0.5, 0}, {-0.5, 0});
            bodies.push_back(plank), last = plank;
          }
          hinge(last, ground, {0.5, 0}, {double(planks), 0});
          const double mass = world.mass(last);
          const ShapeGeometry crate = Box{1, 1}, ball = Circle{0.5};
          const bool dropped = load == Load::DroppedBall;
          const BodyId body =
              world.create_body({.position = {0.5 * planks + (dropped ? 0.2 : 0), dropped ? 2.6 : 0.6}},
                                {.geometry = dropped ? ball : crate,
                                 .density = ratio * mass / (dropped ? std::numbers::pi * 0.25 : 1)});
          bodies.push_back(body);
          const double start = energy_of(world, bodies);
          double gained = 0, gap = 0;
          for (int step = 0; step < 120; ++step) {
            world.step(1.0 / 60, 4);
            gained = std::max(gained, (energy_of(world, bodies) - start) / (ratio * mass * kGravity));
            for (const JointId joint : joints) gap = std::max(gap, double(world.read(joint).linear_error));
          }
          const auto which = [&] {
            return std::to_string(planks) + " planks, 1:" + std::to_string(ratio) + ", " +
                   std::string(name_of(solver)) + (dropped ? ", ball" : ", crate");
          };
          EXPECT_LT(gained, 1e-3) << which();
          EXPECT_LT(gap, 0.01) << which();
          EXPECT_GT(double(world.centre(body).y), -0.5 * planks) << which();
        }
      }
    }
  }
}

// Overlapping bodies part with their own masses. The joint yields by 1 % of what moves the light disc; as
// closing it sees a mass ratio of 10, and what presses goes along, the heavy disc moves less than that. With
// that ratio for overlaps too, it moves by 15 % of the overlap.
TYPED_TEST(HeavyLoads, OverlapsAreLeftByTheLightBody) {
  for (const Solver solver : {Solver::SoftSteps, Solver::Direct}) {
    constexpr double kOverlap = 0.02, kMass = 1e4;  // m, times the mass of a light disc
    BasicWorld<TypeParam> world({.gravity = {}, .solver = solver});
    const auto disc = [&](double x, double density) {
      return world.create_body({.position = {x, 0}}, {.geometry = Circle{0.5}, .density = density});
    };
    const BodyId heavy = disc(0, kMass), light = disc(1 - kOverlap, 1), other = disc(3, 1);
    world.create_joint(light, other,
                       {.kind = RevoluteDefinition{.anchor_a = {1 + kOverlap, 0}, .anchor_b = {-1, 0}}});
    for (int step = 0; step < 240; ++step) world.step(1.0 / 60, 4);
    EXPECT_GT(double(world.centre(light).x), 1 - 0.25 * kOverlap) << name_of(solver);
    EXPECT_LT(std::abs(double(world.centre(heavy).x)), 0.01 * kOverlap) << name_of(solver);
  }
}

}  // namespace
}  // namespace plumb
