// Blows on bodies whose joints have limits that are far away: they act as if the joint had none. Closed forms
// of an inelastic impact on what a joint leaves free.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "engine/world/world.h"

namespace plumb {
namespace {

enum class Holder { Slider, Wheel, Rope, Hinge };

struct Blow {
  double struck = 0;    ///< kg, of the plank of 2 m that a joint holds
  double mass = 0;      ///< kg, of the ball that strikes it
  double speed = 0;     ///< m/s
  double distance = 0;  ///< m, before the impact
};

Blow random_blow(std::mt19937_64& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Blow blow;
  blow.struck = between(0.3, 3), blow.mass = blow.struck * between(0.3, 10);
  blow.speed = between(2, 15), blow.distance = between(0, 0.3);
  return blow;
}

JointDefinition held_by(Holder holder) {
  const Range limits{-50, 50};
  switch (holder) {
    case Holder::Slider:
      return {.kind = PrismaticDefinition{.axis = {0, 1}, .limits = limits}};
    case Holder::Wheel:
      return {.kind = WheelDefinition{.axis = {0, 1}, .limits = limits}};
    case Holder::Rope:
      return {.kind = DistanceDefinition{.anchor_a = {0, -3}, .range = Range{0.5, 50}}};
    case Holder::Hinge:
      break;
  }
  return {.kind = RevoluteDefinition{.anchor_a = {-1, 0}, .anchor_b = {-1, 0}, .limits = limits}};
}

// Returns the ball's speed after the impact, m/s.
template <class Real>
double speed_after(const Blow& blow, Holder holder, Solver solver) {
  BasicWorld<Real> world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
  const BodyId ground = world.create_body({.type = BodyType::Static});
  const BodyId plank = world.create_body(
      {}, {.geometry = Box{2, 0.1}, .density = blow.struck / 0.2, .material = {.friction = 0}});
  world.create_joint(ground, plank, held_by(holder));
  const double across = holder == Holder::Hinge ? 0.5 : 0;
  const BodyId ball = world.create_body({.position = {across, -0.25 - blow.distance},
                                         .velocity = {0, blow.speed},
                                         .mass = MassProperties{blow.mass, {}, 0.02 * blow.mass}},
                                        {.geometry = Circle{0.2}, .material = {.friction = 0}});
  const auto was_struck = [&] { return world.velocity(ball).y < 0.999 * blow.speed; };
  for (int i = 0; i < 20 && !was_struck(); ++i) world.step();
  for (int i = 0; i < 3; ++i) world.step();
  return world.velocity(ball).y;
}

// Returns M v / (M + m'), where m' is the mass of the plank as the ball feels it: m, or I / r^2 about a
// hinge.
double expected_speed(const Blow& blow, Holder holder) {
  const double about_end = (4 + 0.01) / 12 + 1, arm = 1.5;
  const double felt = holder == Holder::Hinge ? blow.struck * about_end / (arm * arm) : blow.struck;
  return blow.mass * blow.speed / (blow.mass + felt);
}

template <class Real>
void expect_momentum_kept(Holder holder, Solver solver, double tolerance) {
  std::mt19937_64 random(20261130);
  for (int seed = 0; seed < 100; ++seed) {
    const Blow blow = random_blow(random);
    EXPECT_NEAR(speed_after<Real>(blow, holder, solver), expected_speed(blow, holder), tolerance * blow.speed)
        << "blow " << seed;
  }
}

TEST(BlowsBeforeLimits, TakeNoMomentumFromWhatSlides) {
  for (const Holder holder : {Holder::Slider, Holder::Wheel, Holder::Rope}) {
    for (const Solver solver : {Solver::SoftSteps, Solver::Direct}) {
      expect_momentum_kept<double>(holder, solver, 1e-6);
      expect_momentum_kept<float>(holder, solver, 1e-4);
    }
  }
}

// The plank turns by up to (w dt)^2 / 2 = 0.5 % of the arm while the impact is solved within a step.
TEST(BlowsBeforeLimits, TakeNoMomentumFromWhatTurns) {
  for (const Solver solver : {Solver::SoftSteps, Solver::Direct}) {
    expect_momentum_kept<double>(Holder::Hinge, solver, 0.005);
    expect_momentum_kept<float>(Holder::Hinge, solver, 0.005);
  }
}

// A cart that is struck just before its buffer hits it afterwards, and stays there.
TEST(BlowsBeforeLimits, StopAtLimitsThatAreReached) {
  for (int phase = 0; phase < 20; ++phase) {
    DoubleWorld world({.gravity = {0, 0}, .sleeping = false});
    const BodyId ground = world.create_body({.type = BodyType::Static});
    const BodyId cart = world.create_body({}, {.geometry = Box{2, 0.1}, .density = 5});
    world.create_joint(ground, cart,
                       {.kind = PrismaticDefinition{.axis = {0, 1}, .limits = Range{-1, 0.05}}});
    world.create_body({.position = {0, -0.5 - 0.007 * phase}, .velocity = {0, 8}}, {.geometry = Circle{0.2}});
    double farthest = 0;
    for (int i = 0; i < 60; ++i) world.step(), farthest = std::max(farthest, world.position(cart).y);
    EXPECT_LT(farthest, 0.05 + 1e-3) << phase;
    EXPECT_NEAR(world.position(cart).y, 0.05, 1e-3) << phase;
  }
}

}  // namespace
}  // namespace plumb
