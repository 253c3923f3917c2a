// Bodies with gravity, joints and wind of their own, held to figures 2 % beside the closed form on either
// side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/world/force_laws.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

template <class Real>
class LoadsNearTheEdge : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(LoadsNearTheEdge, Reals);

constexpr double kPi = std::numbers::pi;
constexpr Solver kSolvers[] = {Solver::SoftSteps, Solver::SequentialImpulses, Solver::Jakobsen, Solver::Xpbd,
                               Solver::Direct};

// ---- Masses off the origin

// The flipper's origin is its hinge; where it strikes, 2 m out, it moves at 2 m/s. What it strikes
// elastically, at rest and a million times lighter than a kinematic body, leaves at twice that.
TYPED_TEST(LoadsNearTheEdge, AFlipperStrikesWithTheSpeedOfWhereItStrikes) {
  for (const bool two_shapes : {false, true}) {
    BasicWorld<TypeParam> world(weightless());
    const Material elastic{.friction = 0, .restitution = 1};
    const BodyId flipper = world.create_body(
        {.type = BodyType::Kinematic, .angular_velocity = 1},
        ShapeDefinition{.geometry = Box{0.4, 0.2}, .position = {2, 0}, .material = elastic});
    if (two_shapes) world.create_shape(flipper, {.geometry = Box{0.4, 0.2}, .position = {-7, 0}});
    const BodyId ball = add_body(world, {2, 0.31}, {.geometry = Circle{0.2}, .material = elastic});
    run(world, 12);
    EXPECT_NEAR(world.velocity(ball).y, 4, 0.02 * 4);
    EXPECT_NEAR(world.position(flipper).x, 0, 1e-6);
  }
}

// Material that is there moves as it did, whatever is added to it or taken away: the spin is the same, and
// the velocity of each point.
TYPED_TEST(LoadsNearTheEdge, ChangesOfMassLeaveSpinAndTheMotionOfEachPoint) {
  using World = BasicWorld<TypeParam>;
  using Change = void (*)(World&, BodyId);
  const Change changes[] = {
      [](World& w, BodyId body) {
        w.create_shape(body, {.geometry = Box{1, 2}, .position = {3, 1}, .density = 5});
      },
      [](World& w, BodyId body) { w.destroy(w.shapes(body)[1]); },
      [](World& w, BodyId body) {
        w.set_mass(body, {.mass = 7, .centre = {-2, 1}, .inertia = 3});
      },
      [](World& w, BodyId body) {
        w.set_mass(body, {.mass = 7, .centre = {-2, 1}, .inertia = 3});
        w.use_densities(body);
      },
      [](World& w, BodyId body) {
        w.set_type(body, BodyType::Kinematic);
        w.set_type(body, BodyType::Dynamic);
      },
  };
  for (const bool stepped : {false, true}) {
    int which = 0;
    for (const Change change : changes) {
      World world(weightless());
      const BodyId body =
          world.create_body({.position = {1, 2}, .angle = 0.7, .velocity = {1, -2}, .angular_velocity = 3},
                            std::vector<ShapeDefinition>{{.geometry = Box{1, 1}},
                                                         {.geometry = Circle{0.5}, .position = {2, 0}}});
      const Vec2d points[] = {{1, 2}, {0, 0}, {4, -3}};
      std::vector<Vec2d> before;
      for (const Vec2d point : points) before.push_back(world.velocity_at(body, point));
      change(world, body);
      if (stepped) world.step(1e-7, 1);
      EXPECT_NEAR(world.angular_velocity(body), 3, 1e-6) << which;
      for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_NEAR(world.velocity_at(body, points[i]).x, before[i].x, 1e-5) << which << " " << stepped;
        EXPECT_NEAR(world.velocity_at(body, points[i]).y, before[i].y, 1e-5) << which << " " << stepped;
      }
      ++which;
    }
  }
}

// Anchors stand in the body's frame: where its centre of mass goes does not move them.
TYPED_TEST(LoadsNearTheEdge, JointsHoldTheSamePointWhereverTheMassGoes) {
  BasicWorld<TypeParam> world(without_sleep());
  const BodyId nail = world.create_body({.type = BodyType::Static});
  const BodyId body = world.create_body({.position = {0, -1}}, ShapeDefinition{.geometry = Box{0.5, 0.5}});
  const JointId hinge = world.create_joint(nail, body, {.kind = RevoluteDefinition{.anchor_b = {0, 1}}});
  world.step();
  world.create_shape(body, {.geometry = Box{0.5, 0.5}, .position = {0.5, 0}, .density = 4});
  for (int i = 0; i < 60; ++i) {
    world.step();
    const Vec2d held = world.world_point(body, {0, 1});
    ASSERT_NEAR(std::hypot(held.x, held.y), 0, 2e-3) << i;
  }
  EXPECT_LT(world.read(hinge).linear_error, 2e-3);
}

// ---- Gravity of its own, with a joint or a contact

// Of two equal bodies on a rope over pulleys one has 2 % more gravity: it goes down with a hundredth of g.
TYPED_TEST(LoadsNearTheEdge, AnAtwoodMachineWeighsGravityScales) {
  for (const Solver solver : kSolvers) {
    for (const double scale : {0.98, 1.02}) {
      WorldDefinition settings = without_sleep();
      settings.solver = solver;
      BasicWorld<TypeParam> world(settings);
      const BodyId a = add_box(world, {0, -2}), b = add_box(world, {4, -2});
      world.set_gravity_scale(b, scale);
      world.create_joint(a, b, {.kind = PulleyDefinition{.ground_a = {0, 0}, .ground_b = {4, 0}}});
      run(world, 60);
      const double fallen = (scale - 1) / 2 * kGravity / 2;
      EXPECT_NEAR(world.position(b).y + 2, -fallen, 0.05 * std::abs(fallen))
          << name_of(solver) << " " << scale;
      EXPECT_NEAR(world.position(a).y + 2, fallen, 0.05 * std::abs(fallen))
          << name_of(solver) << " " << scale;
    }
  }
}

// Down a slope of 30 degrees without friction: s = scale g sin(30 degrees) t^2/2.
TYPED_TEST(LoadsNearTheEdge, WhatSlidesFallsWithItsOwnGravity) {
  for (const Solver solver : kSolvers) {
    for (const double scale : {0.5, 0.98, 1.02, 2.0}) {
      WorldDefinition settings = without_sleep();
      settings.solver = solver;
      BasicWorld<TypeParam> world(settings);
      const Material ice{.friction = 0};
      const Vec2d up{std::sin(kPi / 6), std::cos(kPi / 6)}, down{std::cos(kPi / 6), -std::sin(kPi / 6)};
      world.create_body({.type = BodyType::Static, .angle = -kPi / 6},
                        ShapeDefinition{.geometry = Box{100, 2}, .position = {0, -1}, .material = ice});
      const BodyId box = world.create_body({.position = 0.5 * up, .angle = -kPi / 6},
                                           ShapeDefinition{.geometry = Box{1, 1}, .material = ice});
      world.set_gravity_scale(box, scale);
      run(world, 60);
      const double way = scale * kGravity * std::sin(kPi / 6) / 2;
      EXPECT_NEAR(dot(world.position(box), down), way, 0.01 * way) << name_of(solver) << " " << scale;
    }
  }
}

// A pendulum let go from the side keeps its energy: (I + m L^2) w^2/2 = scale m g L (below where it began).
TYPED_TEST(LoadsNearTheEdge, APendulumSwingsWithItsOwnGravity) {
  for (const double scale : {0.5, 0.98, 1.02, 3.0}) {
    BasicWorld<TypeParam> world(without_sleep());
    const BodyId nail = world.create_body({.type = BodyType::Static});
    const BodyId bob = add_body(world, {1, 0}, {.geometry = Circle{0.1}, .density = 100});
    world.set_gravity_scale(bob, scale);
    world.create_joint(nail, bob, {.kind = RevoluteDefinition{.anchor_b = {-1, 0}}});
    const double m = world.mass(bob), inertia = world.inertia(bob) + m;
    double fastest = 0;
    for (int i = 0; i < 120; ++i) {
      world.step();
      fastest = std::max(fastest, std::abs(world.angular_velocity(bob)));
    }
    const double exact = std::sqrt(2 * scale * m * kGravity / inertia);
    EXPECT_NEAR(fastest, exact, 0.005 * exact) << scale;
  }
}

// A ball that bounces elastically comes back to where it was let go after 2 sqrt(2 h/(scale g)): impacts are
// placed on the parabola that it flies on.
TYPED_TEST(LoadsNearTheEdge, WhatBouncesComesBackWithItsOwnGravity) {
  for (const double scale : {0.25, 0.98, 1.02, 4.0}) {
    BasicWorld<TypeParam> world(without_sleep());
    const Material elastic{.restitution = 1};
    add_ground(world, elastic);
    const BodyId ball = add_body(world, {0, 2.5}, {.geometry = Circle{0.5}, .material = elastic});
    world.set_gravity_scale(ball, scale);
    const double back = 2 * std::sqrt(2 * 2 / (scale * kGravity));
    const int steps = static_cast<int>(std::lround(back * 240));
    run(world, steps, back / steps);
    // At the top of its way it shows in the speed: 2 % of the scale are 1 % of the time, 0.01 scale g back.
    EXPECT_NEAR(world.position(ball).y, 2.5, 2e-3) << scale;
    EXPECT_NEAR(world.velocity(ball).y, 0, 0.004 * scale * kGravity * back) << scale;
  }
}

// ---- What joints bear

// The load comes on over 4 s: what limits and motors hold swings up and down by half of it where it comes at
// once.
template <class Real>
bool breaks(Solver solver, const JointKind& kind, Vec2d at, double force, double torque) {
  WorldDefinition settings = without_sleep();
  settings.solver = solver;
  BasicWorld<Real> world(settings);
  const BodyId nail = world.create_body({.type = BodyType::Static});
  const BodyId body = add_box(world, at);
  const JointId joint =
      world.create_joint(nail, body, {.kind = kind, .break_force = force, .break_torque = torque});
  for (int i = 1; i <= 300; ++i) {
    world.set_gravity({0, -kGravity * std::min(1.0, i / 240.0)});
    world.step();
  }
  return !world.valid(joint);
}

struct Bearing {
  const char* name;
  JointKind kind;
  Vec2d at;
  double force, torque;  // load that it bears there, N and N m; 0: not tried
};

TYPED_TEST(LoadsNearTheEdge, JointsBreakAtTheForceAndTorqueThatTheyWereGiven) {
  const double weight = kGravity, lever = 2 * kGravity;  // of 1 kg, and of 1 kg at 2 m
  const Motor holds{.speed = 0, .max_force = 1e6};
  const Range shut{0, 0};
  const Bearing bearings[] = {
      {"rope", DistanceDefinition{.range = Range{0, 2}}, {0, -2}, weight, 0},
      {"pulley", PulleyDefinition{.ground_a = {0, 1}, .ground_b = {0, 1}}, {0, -2}, weight, 0},
      {"beam in a slot", PrismaticDefinition{.anchor_b = {-2, 0}, .axis = {1, 0}}, {2, 0}, weight, lever},
      {"beam with a limit", RevoluteDefinition{.anchor_b = {-2, 0}, .limits = shut}, {2, 0}, 0, lever},
      {"beam with a motor", RevoluteDefinition{.anchor_b = {-2, 0}, .motor = holds}, {2, 0}, 0, lever},
      {"slider on its limit", PrismaticDefinition{.axis = {0, 1}, .limits = shut}, {0, 0}, weight, 0},
      {"slider with a motor", PrismaticDefinition{.axis = {0, 1}, .motor = holds}, {0, 0}, weight, 0},
      {"wheel on its limit", WheelDefinition{.axis = {0, 1}, .limits = shut}, {0, 0}, weight, 0},
      {"friction", FrictionDefinition{.max_force = 1e6, .max_torque = 1e6}, {0, 0}, weight, 0},
  };
  for (const Bearing& bearing : bearings) {
    for (const Solver solver : {Solver::SoftSteps, Solver::Direct}) {
      const std::string which = std::string(bearing.name) + " by " + name_of(solver);
      const auto at = [&](double force, double torque) {
        return breaks<TypeParam>(solver, bearing.kind, bearing.at, force, torque);
      };
      if (bearing.force > 0) {
        EXPECT_FALSE(at(1.02 * bearing.force, 0)) << which;
        EXPECT_TRUE(at(0.98 * bearing.force, 0)) << which;
      }
      if (bearing.torque > 0) {
        EXPECT_FALSE(at(0, 1.02 * bearing.torque)) << which;
        EXPECT_TRUE(at(0, 0.98 * bearing.torque)) << which;
      }
    }
  }
}

// ---- Wind on what spins

// A sail of 1 m stands out from 1 m to 2 m; its middle, where the flow is taken, goes at 1.5 times the spin.
// Air that comes after it at the same speed does not press on it; 2 % slower or faster it brakes or drives.
TYPED_TEST(LoadsNearTheEdge, WindDrivesWhatSpinsSlowerAndBrakesWhatSpinsFaster) {
  const double dt = 1.0 / 60, density = 1.2, inertia = 100;
  for (const double turned : {0.0, 0.5, kPi / 2}) {
    for (const double spin : {-2.0, 0.0, 1.96, 2.0, 2.04}) {
      BasicWorld<TypeParam> world(weightless());
      const BodyId sail =
          world.create_body({.angle = turned,
                             .angular_velocity = spin,
                             .mass = MassProperties{.mass = 1000, .centre = {0, 0}, .inertia = inertia}},
                            ShapeDefinition{.geometry = Box{1, 0.2}, .position = {1.5, 0}});
      const Vec2d way{-std::sin(turned), std::cos(turned)};  // of the sail, and of the wind
      apply_wind(world, {.velocity = 3.0 * way, .density = density}, dt);
      world.step(dt, 4);
      const double flow = 3 - 1.5 * spin, force = density / 2 * flow * std::abs(flow) * 1;
      EXPECT_NEAR((world.angular_velocity(sail) - spin) * inertia, 1.5 * force * dt,
                  0.01 * 1.5 * std::abs(force) * dt + 2e-5)
          << spin << " " << turned;
      EXPECT_NEAR(dot(world.velocity(sail), way) * 1000, force * dt, 0.01 * std::abs(force) * dt + 2e-5)
          << spin;
    }
  }
}

// A disc off the axis meets the air at w times its distance: over the half that faces it, the integral of
// rho/2 v^2 cos^2 along the way gives rho/2 v^2 (4/3) r.
TYPED_TEST(LoadsNearTheEdge, WindBrakesADiscThatGoesRound) {
  const double dt = 1.0 / 60, density = 1.2, inertia = 100, spin = 4, arm = 1.5, radius = 0.25;
  BasicWorld<TypeParam> world(weightless());
  const BodyId body = world.create_body(
      {.angular_velocity = spin, .mass = MassProperties{.mass = 1000, .centre = {0, 0}, .inertia = inertia}},
      ShapeDefinition{.geometry = Circle{radius}, .position = {0, arm}});
  apply_wind(world, {.density = density}, dt);
  world.step(dt, 4);
  const double speed = spin * arm, force = density / 2 * speed * speed * 4 / 3 * radius;
  EXPECT_NEAR((spin - world.angular_velocity(body)) * inertia, force * arm * dt, 0.01 * force * arm * dt);
  EXPECT_NEAR(world.velocity(body).x * 1000, force * dt, 0.01 * force * dt);
}

}  // namespace
}  // namespace plumb
