#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "tests/world/support.h"

// A weightless belt of n links lies over a drum, with a load at either end. Truth is statics: where the belt
// bends by an angle u between two links, a contact that is about to slip has
//     N = (T1 + T2) sin(u/2),   T2 cos(u/2) - T1 cos(u/2) = mu N,
// so that T2/T1 = (1 + mu tan(u/2)) / (1 - mu tan(u/2)), and n of these hold a load ratio of its n-th power:
// exp(mu n u) for many (Euler and Eytelwein).
namespace plumb {
namespace {

template <class Real>
class Belt : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Belt, Reals);

constexpr double kDrum = 1, kLink = 0.02, kFriction = 0.5, kWrap = std::numbers::pi, kStep = 1.0 / 60;

double ratio_held(int n) {
  const double side = kFriction * std::tan(kWrap / n / 2);
  return std::pow((1 + side) / (1 - side), n);
}

// The lighter load has 1 kg; the heavier one has `heavier` times what friction and the lighter one hold.
template <class Real>
struct LoadedBelt {
  LoadedBelt(int n, double link_mass, double heavier) : world({.sleeping = false}) {
    const Material material{.friction = kFriction};
    const double bend = kWrap / n, radius = kDrum + kLink;
    world.create_body({.type = BodyType::Static}, {.geometry = Circle{kDrum}, .material = material});
    BodyId first{}, last{};
    for (int i = 0; i < n; ++i) {
      const double at = std::numbers::pi / 2 + kWrap / 2 - (i + 0.5) * bend;
      const BodyId link =
          world.create_body({.position = {radius * std::cos(at), radius * std::sin(at)},
                             .mass = MassProperties{.mass = link_mass, .inertia = link_mass * kLink * kLink},
                             .gravity_scale = 0,
                             .lock_rotation = true},
                            {.geometry = Circle{kLink}, .material = material});
      if (i == 0)
        first = link;
      else
        world.create_joint(last, link,
                           {.kind = DistanceDefinition{.length = 2 * radius * std::sin(bend / 2)}});
      last = link;
    }
    hang(first, 1), load = hang(last, heavier * ratio_held(n));
    height = world.position(load).y;
  }

  BodyId hang(BodyId link, double mass) {
    const Vec2d at = world.position(link);
    const BodyId body = world.create_body({.position = {at.x, at.y - 1},
                                           .mass = MassProperties{.mass = mass, .inertia = mass},
                                           .lock_rotation = true});
    world.create_joint(link, body, {.kind = DistanceDefinition{.length = 1}});
    return body;
  }
  // Returns how far the heavier load has come down since the last call, m.
  double fall(double seconds) {
    for (int i = 0; i < std::lround(seconds / kStep); ++i) world.step(kStep);
    const double before = height;
    height = world.position(load).y;
    return before - height;
  }

  BasicWorld<Real> world;
  BodyId load{};
  double height = 0;
};

// It begins without forces, so that the first step may lose all of its friction: g dt^2. Bounds of friction
// are found to a thousandth: friction that is off by that gives a speed of a thousandth of what weights give
// in a substep, and is stopped in the next. Positions of link and drum are rounded, which looks like a speed
// too.
TYPED_TEST(Belt, HoldsWhatFrictionCanHold) {
  const double h = kStep / 4;
  const double speed = 1e-3 * 9.81 * h + 2 * std::numeric_limits<TypeParam>::epsilon() * kDrum / h;
  for (const int n : {2, 3, 4, 6, 8, 11, 16}) {
    for (const double link_mass : {0.05, 0.1, 0.3, 1.0}) {
      for (const double share : {0.3, 0.5, 0.65, 0.8, 0.9, 0.98}) {
        LoadedBelt<TypeParam> belt(n, link_mass, share);
        const std::string is =
            std::to_string(n) + " links of " + std::to_string(link_mass) + " kg at " + std::to_string(share);
        EXPECT_LT(std::abs(belt.fall(1)), 9.81 * kStep * kStep) << is;
        EXPECT_LT(std::abs(belt.fall(1)), speed) << is;
      }
    }
  }
}

// Beyond it the loads fall by (M2 - r M1) g / (M2 + r M1 + sum of m q^k), where q is the ratio of one bend:
// each link's inertia is pulled through those behind it. Bends change by a few degrees on the way.
TYPED_TEST(Belt, SlipsBeyondThat) {
  for (const int n : {2, 3, 4, 6, 8, 11, 16}) {
    constexpr double kMass = 0.05;
    const double excess = 1.1, r = ratio_held(n);
    double inertia = r * (excess + 1);
    for (int k = 0; k < n; ++k) inertia += kMass * std::pow(r, (k + 0.5) / n);
    LoadedBelt<TypeParam> belt(n, kMass, excess);
    const double a = 9.81 * r * (excess - 1) / inertia, t = 0.25, way = 0.5 * a * t * t;
    EXPECT_NEAR(belt.fall(t), way, 0.2 * way) << n << " links";
  }
}

}  // namespace
}  // namespace plumb
