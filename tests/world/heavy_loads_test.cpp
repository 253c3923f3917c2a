#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
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

}  // namespace
}  // namespace plumb
