#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/world/support.h"

// Impacts with friction in free flight. Truth is Newton's law for the rate along the normal together with
// Coulomb's law for the impulses, read off the change of the velocities:
//     P = m dv,  I dw = r x P,  u' = -e u,  |P_t| <= mu P_n, and P_t = -mu P_n sign(s') where a slip s' is
//     left.
namespace plumb {
namespace {

constexpr double kDt = 1.0 / 250, kSide = 0.06;

struct Outcome {
  int placed = 0, sticks = 0, slides_on = 0, turns_round = 0;
};

// Throws a square onto a floor by a corner, again and again, and checks each first impact.
Outcome check_throws(double friction, double restitution, int throws) {
  std::mt19937 dice(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(dice() % 10000) / 9999;
  };
  Outcome outcome;
  for (int i = 0; i < throws; ++i) {
    DoubleWorld world({.gravity = {0, 0}, .sleeping = false});
    const Material material{.friction = friction, .restitution = restitution};
    add_ground(world, material);
    const Vec2d v{between(-1.5, 1.5), -between(1, 3)};
    const double w = between(-15, 15), angle = between(0.15, 1.4), reach = kSide / std::sqrt(2.0);
    BodyDefinition definition{.position = {0, reach + between(0.003, 0.05)}, .angle = angle, .velocity = v};
    definition.angular_velocity = w;
    const BodyId square =
        world.create_body(definition, ShapeDefinition{.geometry = Box{kSide, kSide}, .material = material});
    int steps = 0;
    while (world.velocity(square) == v && steps < 30) world.step(kDt), ++steps;
    EXPECT_LT(steps, 30) << i;
    const double m = world.mass(square), inertia = world.inertia(square);
    const Vec2d after = world.velocity(square), impulse = m * (after - v);
    const double spin = world.angular_velocity(square), turn = inertia * (spin - w);
    // Before the impact at t it moved by v, after it by the new velocity.
    const double t =
        (world.position(square).y - definition.position.y - after.y * steps * kDt) / (v.y - after.y);
    const double at = angle + w * t, height = definition.position.y + v.y * t;
    Vec2d arm{};  // to the lowest corner
    for (int corner = 0; corner < 4; ++corner) {
      const double to = at + (0.25 + 0.5 * corner) * M_PI;
      const Vec2d r{reach * std::cos(to), reach * std::sin(to)};
      if (r.y < arm.y) arm = r;
    }
    if (std::abs(height + arm.y) > 1e-9) continue;  // a second impact in the step
    ++outcome.placed;
    const auto rate = [&](Vec2d velocity, double angular) {
      return Vec2d{velocity.x - angular * arm.y, velocity.y + angular * arm.x};
    };
    const Vec2d before_rate = rate(v, w), after_rate = rate(after, spin);
    const double scale = m * std::abs(before_rate.y);
    EXPECT_NEAR(turn, arm.x * impulse.y - arm.y * impulse.x, 1e-9 * scale * reach) << i;
    // A law that would gain energy is scaled back to none: then it is less than Newton's.
    const double gained =
        0.5 * m * (length_squared(after) - length_squared(v)) + 0.5 * inertia * (spin * spin - w * w);
    EXPECT_LT(gained, 1e-9 * scale) << i;
    if (gained < -1e-9 * scale) {
      EXPECT_NEAR(after_rate.y, -restitution * before_rate.y, 1e-8 * std::abs(before_rate.y)) << i;
    }
    const double slip = after_rate.x, rubbed = friction * impulse.y;
    EXPECT_LE(std::abs(impulse.x), rubbed + 1e-9 * scale) << i;
    if (std::abs(slip) > 1e-8) {
      if (gained < -1e-9 * scale) {
        EXPECT_NEAR(impulse.x, slip > 0 ? -rubbed : rubbed, 1e-8 * scale) << i;
      }
      ++(slip * before_rate.x > 0 ? outcome.slides_on : outcome.turns_round);
    } else {
      ++outcome.sticks;
    }
  }
  return outcome;
}

TEST(FrictionalImpacts, StickSlideOnOrTurnTheSlipRoundByCoulombsLaw) {
  const Outcome slippery = check_throws(0.1, 0.5, 300);
  EXPECT_GT(slippery.placed, 285);
  EXPECT_GT(slippery.slides_on, 30);
  EXPECT_GT(slippery.turns_round, 30);
  const Outcome rough = check_throws(0.8, 0.5, 300);
  EXPECT_GT(rough.placed, 285);
  EXPECT_GT(rough.sticks, 30);
  check_throws(0.3, 1, 100);
}

// Without restitution the corner does not rebound, whatever friction does to it. Afterwards its normal speed
// is what turning makes of it in a step: at most w^2 r dt, with the faster of both spins.
TEST(FrictionalImpacts, DoNotReboundWithoutRestitution) {
  constexpr double kStep = 1.0 / 60, kWide = 1;
  const double reach = kWide / std::sqrt(2.0);
  std::mt19937 dice(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(dice() % 10000) / 9999;
  };
  int throws = 0, rebounds = 0;
  for (const double friction : {0.0, 0.1, 0.3, 0.8}) {
    for (int i = 0; i < 400; ++i) {
      DoubleWorld world({.gravity = {0, 0}, .sleeping = false});
      const Material material{.friction = friction};
      add_ground(world, material);
      const Vec2d v{between(-5, 5), -between(2, 8)};
      const double w = between(-20, 20), angle = between(0.15, 1.4);
      BodyDefinition definition{.position = {0, reach + between(0.01, 0.5)}, .angle = angle, .velocity = v};
      definition.angular_velocity = w;
      const BodyId square =
          world.create_body(definition, ShapeDefinition{.geometry = Box{kWide, kWide}, .material = material});
      while (world.velocity(square) == v) world.step(kStep);
      Vec2d arm{};  // to the lowest corner
      for (int corner = 0; corner < 4; ++corner) {
        const double to = world.angle(square) + (0.25 + 0.5 * corner) * M_PI;
        const Vec2d r{reach * std::cos(to), reach * std::sin(to)};
        if (r.y < arm.y) arm = r;
      }
      const double spin = world.angular_velocity(square), approach = -(v.y + w * arm.x);
      if (approach < 1) continue;
      const double turning = std::max(w * w, spin * spin) * reach * (kStep + kStep / 4);
      ++throws;
      if (world.velocity(square).y + spin * arm.x > turning) ++rebounds;
    }
  }
  EXPECT_GT(throws, 1500);
  EXPECT_LE(100 * rebounds, throws);
}

// A wide box lands flat and slides: both corners are struck at once. Friction turns it; the corners take that
// up by unequal impulses, so that it does not spin.
TEST(FrictionalImpacts, OfABoxThatLandsFlatDoNotSpinIt) {
  for (const double friction : {0.1, 0.3, 5.0}) {
    DoubleWorld world({.gravity = {0, 0}, .sleeping = false});
    const Material material{.friction = friction, .restitution = 0.5};
    add_ground(world, material);
    const BodyId box = add_body(world, {0, 0.26}, {.geometry = Box{4, 0.5}, .material = material}, {3, -2});
    run(world, 2);
    const double slowed = std::min(friction * 1.5 * 2, 3.0);
    EXPECT_NEAR(world.velocity(box).x, 3 - slowed, 1e-12) << friction;
    EXPECT_NEAR(world.velocity(box).y, 1, 1e-12) << friction;
    EXPECT_NEAR(world.angular_velocity(box), 0, 1e-12) << friction;
  }
}

// A body made by a call has no box yet that reaches to where it will be.
TEST(FrictionalImpacts, AreSeenComingInTheFirstStep) {
  DoubleWorld world({.gravity = {0, 0}, .sleeping = false});
  const Material smooth{.friction = 0, .restitution = 1};
  add_ground(world, smooth);
  const BodyId disc = add_body(world, {0, 0.6}, {.geometry = Circle{0.5}, .material = smooth}, {0, -12});
  world.step();
  EXPECT_NEAR(world.position(disc).y, 0.5 + 12.0 / 60 - 0.1, 1e-9);
  EXPECT_NEAR(world.velocity(disc).y, 12, 1e-9);
}

// A tilted block turns about the corner on which it stands until the other one lands: its centre moves as
// w x r, which the load on that corner sees to.
TEST(FrictionalImpacts, ARockingBlockStandsOnItsCornerUntilTheOtherLands) {
  DoubleWorld world({.gravity = {0, -kGravity}, .sleeping = false});
  const Material rough{.friction = 0.8};
  add_ground(world, rough);
  constexpr double kWidth = 0.2, kHeight = 0.8;
  const double alpha = std::atan(kWidth / kHeight), tilt = 0.6 * alpha,
               reach = std::hypot(kWidth, kHeight) / 2;
  BodyDefinition definition{.position = {-reach * std::sin(alpha - tilt), reach * std::cos(alpha - tilt)},
                            .angle = -tilt};
  const BodyId block =
      world.create_body(definition, ShapeDefinition{.geometry = Box{kWidth, kHeight}, .material = rough});
  constexpr double kStep = 1.0 / 240;
  double fastest = 0;
  for (;;) {
    world.step(kStep);
    const double w = world.angular_velocity(block), at = world.angle(block);
    if (at >= 0) break;
    const Vec2d r{-reach * std::sin(alpha + at), reach * std::cos(alpha + at)};
    fastest = std::max(fastest, w);
    // An arm turns by w dt in a step, in which it is held where it was: up to w^2 dt r. It falls no faster.
    const double allowed = 2 * w * w * kStep * reach + 1e-3;
    EXPECT_GT(world.velocity(block).y, w * r.x - allowed) << at;
    if (at + w * kStep < 0) {  // the other corner is not met yet
      EXPECT_NEAR(world.velocity(block).x, -w * r.y, allowed) << at;
      EXPECT_NEAR(world.velocity(block).y, w * r.x, allowed) << at;
    }
  }
  EXPECT_GT(fastest, 0.85);  // rad/s
}

}  // namespace
}  // namespace plumb
