#include "engine/precise/precise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/scene/error.h"
#include "tests/precise/support.h"
#include "tests/precise/truth.h"

namespace plumb {
namespace {

using truth::Real;

/// |value - expected| relative to the size of what is expected.
void expect_relative(double value, Real expected, double tolerance) {
  EXPECT_LE(std::abs(value - expected), tolerance * std::abs(expected)) << value << " against " << expected;
}

TEST(Precise, FreeFallIsThePolynomial) {
  Scene scene{.name = "fall"};
  scene.bodies = {{.name = "dropped", .position = {0, 0}, .inertia = 1},
                  {.name = "thrown", .position = {1, 2}, .velocity = {3, 20}, .mass = 1e6, .inertia = 1}};
  const auto states = run(scene, 600);
  const Real t = 600 * (1.0 / 60);
  expect_relative(states[0].position.y, -9.81L / 2 * t * t, 1e-15);
  expect_relative(states[1].position.x, 1 + 3 * t, 1e-15);
  expect_relative(states[1].position.y, 2 + 20 * t - 9.81L / 2 * t * t, 1e-15);
  expect_relative(states[1].velocity.y, 20 - 9.81L * t, 1e-15);
  EXPECT_EQ(run(scene, 6, {.max_dt = 100.0 / 60})[0].position, states[0].position) << "at any step";
}

TEST(Precise, DampedBodiesDecayAsTheirDefinitionSays) {
  // v' = -c v + s g: v = v0 e^(-c t) + (s g / c) (1 - e^(-c t)), and x its integral; the spin decays alike.
  Scene scene{.name = "damped", .gravity = {0, -9.81}};
  scene.bodies = {ball("ball", {0, 0}, {3, 4}, 2.5)};
  scene.bodies[0].angular_velocity = 5;
  for (const double c : {0.3, 7.0, 400.0}) {
    for (const double scale : {1.0, -0.5, 0.0}) {
      scene.bodies[0].linear_damping = c, scene.bodies[0].angular_damping = 2 * c;
      scene.bodies[0].gravity_scale = scale;
      const double t = 1, kept = std::exp(-c * t), way = -std::expm1(-c * t) / c, g = -9.81 * scale;
      const BodyState s = run(scene, 60, {.tolerance = 1e-11})[0];
      EXPECT_NEAR(s.position.x, 3 * way, 2e-10) << c;
      EXPECT_NEAR(s.position.y, 4 * way + g / c * (t - way), 2e-10) << c << " " << scale;
      EXPECT_NEAR(s.velocity.y, 4 * kept + g * way, 2e-10) << c << " " << scale;
      EXPECT_NEAR(s.angle, -5 * std::expm1(-2 * c * t) / (2 * c), 2e-10) << c;
      EXPECT_NEAR(s.angular_velocity, 5 * kept * kept, 2e-10) << c;
    }
  }
  scene.bodies[0].linear_damping = scene.bodies[0].angular_damping = 0;
  scene.bodies[0].gravity_scale = 0.25;
  const BodyState s = run(scene, 60)[0];
  EXPECT_NEAR(s.position.y, 4 - 9.81 / 8, 1e-14) << "on its parabola";
}

TEST(Precise, FreeFallWithLinearDrag) {
  Scene scene{.name = "fall"};
  scene.bodies = {{.name = "ball", .velocity = {3, 5}, .mass = 2, .inertia = 1}};
  scene.forces = {LinearDrag{"ball", 0.6}};
  const auto driver = make_precise_driver(scene, {}, {});
  for (int second = 1; second <= 10; ++second) {
    const BodyState s = advance(*driver, 1, 60)[0];
    // m v' = -m g - c v: v = (v0 - u) e^(-k t) + u, u = -g/k, k = c/m.
    const Real k = 0.3L, t = driver->time(), decay = std::exp(-k * t), u = -9.81L / k;
    expect_relative(s.velocity.x, 3 * decay, 1e-13);
    expect_relative(s.velocity.y, (5 - u) * decay + u, 1e-13);
    expect_relative(s.position.x, 3 * (1 - decay) / k, 1e-13);
    expect_relative(s.position.y, (5 - u) * (1 - decay) / k + u * t, 1e-13);
  }
}

TEST(Precise, FreeFallWithQuadraticDrag) {
  Scene scene{.name = "fall"};
  scene.bodies = {{.name = "ball", .mass = 2, .inertia = 1}};
  scene.forces = {QuadraticDrag{"ball", 0.05}};
  const auto driver = make_precise_driver(scene, {.tolerance = 1e-10}, {});
  const Real terminal = std::sqrt(2 * 9.81L / 0.05L);
  for (int second = 1; second <= 10; ++second) {
    const BodyState s = advance(*driver, 1, 60)[0];
    const Real x = 9.81L * driver->time() / terminal;
    expect_relative(s.velocity.y, -terminal * std::tanh(x), 1e-13);
    expect_relative(s.position.y, -terminal * terminal / 9.81L * std::log(std::cosh(x)), 1e-13);
  }
}

TEST(Precise, WorldForceAtACornerThenFree) {
  // I q'' = r(q) x F for a second, then q'' = 0: integrated here in long double.
  const double mass = 2, width = 1, height = 0.5;
  Body box{.name = "box", .mass = mass};
  box.shapes = {{.geometry = Box{width, height}}};
  Scene scene{.name = "corner", .gravity = {0, 0}};
  scene.bodies = {box};
  scene.forces = {PointForce{"box", {1, 3}, {0.5, 0.25}, Frame::World, 0, 1}};
  const Real inertia = mass * (width * width + height * height) / 12.0L;
  const auto f = [&](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    const Real c = std::cos(y[0]), s = std::sin(y[0]);
    const Real rx = c * 0.5L - s * 0.25L, ry = s * 0.5L + c * 0.25L;
    out = {y[1], (rx * 3 - ry * 1) / inertia};
  };
  const auto turned = truth::integrate_twice(f, {0, 0}, 0, 1, 5000);
  for (const double max_dt : {1.0 / 60, 0.4}) {  // at 0.4 the force ends inside a step
    const int steps = max_dt < 0.1 ? 120 : 5;
    const BodyState s = run(scene, steps, {.max_dt = max_dt})[0];
    EXPECT_NEAR(s.angle, static_cast<double>(turned[0] + turned[1]), 4e-12);
    EXPECT_NEAR(s.angular_velocity, static_cast<double>(turned[1]), 4e-12);
    EXPECT_NEAR(s.velocity.x, 0.5, 1e-14);
    EXPECT_NEAR(s.velocity.y, 1.5, 1e-14);
    EXPECT_NEAR(s.position.x, 0.25 + 0.5, 1e-14);
    EXPECT_NEAR(s.position.y, 0.75 + 1.5, 1e-14);
  }
}

TEST(Precise, ThrusterFollowsFresnelsIntegrals) {
  // A body-fixed force off the centre: angle = alpha t^2/2, v = F/m (int cos, int sin)(alpha t^2/2).
  Scene scene{.name = "thruster", .gravity = {0, 0}};
  scene.bodies = {{.name = "rocket", .mass = 2, .inertia = 0.5}};
  scene.forces = {PointForce{"rocket", {4, 0}, {0, -0.25}, Frame::Body}};  // torque = 1, alpha = 2
  const BodyState s = run(scene, 300)[0];
  const Real t = 300 * (1.0 / 60);
  EXPECT_NEAR(s.angle, static_cast<double>(t * t), 1e-12);
  const Real vx = truth::integral([](Real x) { return 2 * std::cos(x * x); }, t, 20000);
  const Real vy = truth::integral([](Real x) { return 2 * std::sin(x * x); }, t, 20000);
  EXPECT_NEAR(s.velocity.x, static_cast<double>(vx), 1e-11);
  EXPECT_NEAR(s.velocity.y, static_cast<double>(vy), 1e-11);
  // x = int (t - u) F/m cos(u^2) du
  const Real x = truth::integral([&](Real u) { return (t - u) * 2 * std::cos(u * u); }, t, 20000);
  EXPECT_NEAR(s.position.x, static_cast<double>(x), 1e-11);
}

TEST(Precise, SpinKeepsItsPace) {
  Scene scene{.name = "spin"};
  scene.bodies = {{.name = "top", .angular_velocity = 100, .inertia = 1}};
  expect_relative(run(scene, 600)[0].angle, 1000, 1e-15);
}

TEST(Precise, SwitchedTorqueIsExactInsideAStep) {
  Scene scene{.name = "motor", .gravity = {0, 0}};
  scene.bodies = {{.name = "wheel", .inertia = 2}};
  scene.forces = {Torque{"wheel", 4, 0.3, 0.5}};
  const BodyState s = run(scene, 2, {.max_dt = 1})[0];
  expect_relative(s.angular_velocity, 1, 1e-15);
  expect_relative(s.angle, 0.25L + (2 - 0.8L), 1e-15);
}

void expect_tip(int n, Vec2d expected, double tolerance) {
  const auto states = run(rods(n), 60);
  const Vec2d tip = rod_end(states.back(), 0.5);
  EXPECT_NEAR(tip.x, expected.x, tolerance) << n;
  EXPECT_NEAR(tip.y, expected.y, tolerance) << n;
}

TEST(PreciseChain, PublishedTips) {
  expect_tip(2, {-1.66211513581613, -1.04146663719322}, 1e-11);
  expect_tip(5, {0.533569475142432, -4.91970959757084}, 1e-11);
}

TEST(PreciseChain, TipsOfAMinimalCoordinateIntegration) {
  struct Case {
    int rods, steps;
    double tolerance;
  };
  for (const auto& [n, steps, tolerance] :
       {Case{1, 2000, 1e-12}, Case{20, 300, 1e-10}, Case{100, 50, 1e-6}}) {
    const auto end =
        truth::integrate_twice(truth::chain_of_rods(n, 9.81L), std::vector<Real>(2 * n), 0, 1, steps);
    Real x = 0, y = 0;
    for (int i = 0; i < n; ++i) x += std::cos(end[i]), y += std::sin(end[i]);
    expect_tip(n, {static_cast<double>(x), static_cast<double>(y)}, tolerance);
  }
}

TEST(PreciseChain, KeepsEnergyAndStaysClosed) {
  for (const int n : {1, 2, 5, 20}) {
    const auto driver = make_precise_driver(rods(n), {}, {});
    double drift = 0, gap = 0, scale = 0;
    for (int i = 0; i < 600; ++i) {
      const RodsCheck now = check_rods(advance(*driver, n, 1));
      drift = std::max(drift, std::abs(now.energy));
      gap = std::max(gap, now.gap);
      scale = std::max(scale, now.kinetic);
    }
    EXPECT_LT(drift / scale, 3e-12) << n;
    EXPECT_LT(gap, 5e-14) << n;
  }
}

TEST(PreciseChain, AThousandLinksFall) {
  const int n = 1000;
  const auto driver = make_precise_driver(rods(n), {.tolerance = 1e-6}, {});
  const RodsCheck after = check_rods(advance(*driver, n, 6));
  EXPECT_LT(std::abs(after.energy) / after.kinetic, 1e-9);
  EXPECT_LT(after.gap, 1e-11);
  EXPECT_LT(driver->statistics().evaluations, 1000);
}

TEST(PreciseChain, ErrorFallsWithTheTolerance) {
  double before = 1;
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9}) {
    const auto states = run(rods(5), 2, {.tolerance = tolerance, .max_dt = 0.5});
    const Vec2d tip = rod_end(states.back(), 0.5);
    const double error = std::sqrt(length_squared(tip - Vec2d{0.533569475142432, -4.91970959757084}));
    EXPECT_LT(error, tolerance) << tolerance;
    EXPECT_LT(error, before / 5) << tolerance;
    before = error;
  }
}

TEST(PreciseChain, PendulumPeriodOfALargeSwing) {
  // A point mass on a massless rod released at 90 degrees: T/T0 = 1.18034059901610 (elliptic integral).
  Scene scene{.name = "pendulum", .gravity = {0, -10}};
  scene.bodies = {{.name = "bob", .position = {1, 0}, .inertia = 1}};
  scene.joints = {DistanceJoint{"string", std::string(kWorld), "bob", {}, {}, 1, false}};
  const double period = 2 * kPi * std::sqrt(1.0 / 10) * 1.18034059901610;
  const BodyState s = run(scene, 100, {.max_dt = period / 100})[0];
  EXPECT_NEAR(s.position.x, 1, 1e-12);
  EXPECT_NEAR(s.position.y, 0, 1e-10);
  EXPECT_NEAR(s.velocity.y, 0, 2e-12 * 10);
}

TEST(PreciseChain, FreeChainKeepsMomentum) {
  Scene scene = rods(4);
  scene.joints.erase(scene.joints.begin());
  scene.gravity = {0, 0};
  for (int i = 0; i < 4;
       ++i) {  // one rigid turn, which joints allow, and then they bend from rest differences
    scene.bodies[i].angular_velocity = 2;
    scene.bodies[i].velocity = {0, 2 * (i + 0.5)};
  }
  scene.forces = {Torque{"rod0", 3, 0, 0.5}, Torque{"rod3", -3, 0, 0.5}};
  const auto states = run(scene, 120);
  Vec2d momentum{};
  double angular = 0;
  for (const BodyState& s : states) {
    momentum += s.velocity;
    angular += cross(s.position, s.velocity) + s.angular_velocity / 12;
  }
  EXPECT_NEAR(momentum.x, 0, 1e-12);
  EXPECT_NEAR(momentum.y, 16, 1e-12);
  EXPECT_NEAR(angular, 2 * (4 * 4 * 4) / 3.0, 1e-11);  // I w about the end: m L^2/3 with m = L = 4
}

TEST(PreciseChain, OtherSideOfADistanceJointMayBeKinematic) {
  // A bob below a support that moves evenly swings as below one at rest (Galilean relativity).
  Scene still{.name = "still"};
  still.bodies = {{.name = "support", .type = BodyType::Kinematic},
                  {.name = "bob", .position = {0.6, -0.8}, .inertia = 1}};
  still.joints = {DistanceJoint{"string", "support", "bob", {}, {}, 1, false}};
  Scene moving = still;
  for (Body& body : moving.bodies) body.velocity = {3, 1};
  const auto a = run(still, 90), b = run(moving, 90);
  EXPECT_NEAR(b[1].position.x - b[0].position.x, a[1].position.x, 1e-12);
  EXPECT_NEAR(b[1].position.y - b[0].position.y, a[1].position.y, 1e-12);
  EXPECT_EQ(b[0].position.x, 3 * 1.5);
}

TEST(PreciseChain, RedundantJointsDoNoHarm) {
  Scene doubled = rods(3);
  for (int i = 0; i < 3; ++i) {
    RevoluteJoint again = std::get<RevoluteJoint>(doubled.joints[i]);
    again.name += " again";
    doubled.joints.push_back(again);
  }
  const auto once = run(rods(3), 60), twice = run(doubled, 60);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(once[i].angle, twice[i].angle, 1e-11);
}

TEST(PreciseChain, HeavyTipOnLightRods) {
  // A heavy bob on massless-looking links: the chain falls as a taut one, energy stays.
  Scene scene = rods(10);
  scene.bodies.back().mass = 1e4;
  scene.bodies.back().inertia = 1e4 / 12;
  const auto driver = make_precise_driver(scene, {}, {});
  for (int i = 0; i < 30; ++i) {
    const auto states = advance(*driver, 10, 1);
    double energy = 0, kinetic = 0;
    for (int k = 0; k < 10; ++k) {
      const double m = k == 9 ? 1e4 : 1;
      kinetic += m * (length_squared(states[k].velocity) / 2 +
                      states[k].angular_velocity * states[k].angular_velocity / 24);
      energy += m * 9.81 * states[k].position.y;
    }
    EXPECT_LT(std::abs(energy + kinetic) / kinetic, 1e-10);
    EXPECT_LT(check_rods(states).gap, 1e-13);
  }
}

TEST(PreciseChain, JointThatCannotCloseIsNamed) {
  Scene scene{.name = "torn", .gravity = {0, 0}};
  scene.bodies = {{.name = "bob", .position = {1, 0}, .inertia = 1}};
  scene.joints = {DistanceJoint{"short", std::string(kWorld), "bob", {}, {}, 1, false},
                  DistanceJoint{"far", std::string(kWorld), "bob", {5, 0}, {}, 1, false}};
  const auto driver = make_precise_driver(scene, {}, {});
  try {
    driver->step();
    FAIL() << "closed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Run);
    EXPECT_NE(error.subject().find("joint '"), std::string::npos);
  }
}

TEST(Precise, StateThatGrowsWithoutBoundIsAnError) {
  Scene scene{.name = "blast", .gravity = {0, 0}};
  scene.bodies = {{.name = "shell", .velocity = {1e200, 0}, .mass = 1e-200, .inertia = 1}};
  scene.forces = {QuadraticDrag{"shell", 1e200}};
  const auto driver = make_precise_driver(scene, {}, {});
  try {
    driver->step();
    FAIL() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Run);
    EXPECT_EQ(error.subject(), "body 'shell'");
    EXPECT_NE(error.problem().find("step 1"), std::string::npos);
  }
}

TEST(Precise, StepsDoNotDependOnHowOftenTheyAreLookedAt) {
  Scene scene = rods(3);
  scene.bodies.push_back({.name = "braked", .velocity = {5, 1}, .inertia = 1});
  scene.forces = {QuadraticDrag{"braked", 0.2}, Torque{"rod1", 2, 0.3, 0.125}};
  const auto seldom = make_precise_driver(scene, {.max_dt = 0.5}, {});
  const auto often = make_precise_driver(scene, {.max_dt = 0.5 / 64}, {});
  for (int half = 1; half <= 4; ++half) {
    const auto states = advance(*seldom, 4, 1);
    for (int i = 0; i < 63; ++i) advance(*often, 4, 1);  // reads each time
    EXPECT_EQ(advance(*often, 4, 1), states) << half;
    EXPECT_EQ(often->statistics().steps, seldom->statistics().steps);
  }
}

TEST(Precise, WhatIsReadWithinAStepIsAsGoodAsItsEnd) {
  // 1000 looks at a swing whose steps are some fifty times as long, against elliptic functions by way of
  // energy, and at the rod's length.
  Scene scene = rods(1);
  const auto driver = make_precise_driver(scene, {.max_dt = 1e-3}, {});
  for (int i = 0; i < 1000; ++i) {
    const RodsCheck now = check_rods(advance(*driver, 1, 1));
    EXPECT_LT(std::abs(now.energy), 1e-11);
    EXPECT_LT(now.gap, 1e-15);
  }
  EXPECT_LT(driver->statistics().steps, 100);
}

TEST(Precise, WriteWithinAStepForgetsWhatLiesBeyond) {
  // Two rods apart from each other: writing the one's own state back must not disturb the other beyond
  // rounding, nor lose or repeat time.
  Scene scene = rods(2);
  const auto plain = make_precise_driver(scene, {.max_dt = 1e-3}, {});
  const auto written = make_precise_driver(scene, {.max_dt = 1e-3}, {});
  advance(*plain, 2, 777);
  const auto now = advance(*written, 2, 777);
  for (std::size_t body = 0; body < 2; ++body) written->write(body, now[body]);
  const auto a = advance(*plain, 2, 223), b = advance(*written, 2, 223);
  for (std::size_t body = 0; body < 2; ++body) {
    EXPECT_NEAR(a[body].position.x, b[body].position.x, 1e-12);
    EXPECT_NEAR(a[body].velocity.y, b[body].velocity.y, 1e-11);
  }
}

TEST(Precise, SavedAndRestoredRunsGoOnWithTheSameBits) {
  Scene scene = rods(3);
  scene.bodies.push_back(ball("a", {10, 0}, {1, 0}));
  scene.bodies.push_back(ball("b", {12, 0.2}, {-1, 0}));
  scene.forces = {LinearDrag{"a", 0.1}};
  const auto driver = make_precise_driver(scene, {}, {});
  advance(*driver, 5, 20);
  const auto snapshot = driver->save();
  const auto straight = advance(*driver, 5, 60);
  const auto other = make_precise_driver(scene, {}, {});
  other->restore(snapshot);
  EXPECT_EQ(other->time(), 20 * (1.0 / 60));
  EXPECT_EQ(advance(*other, 5, 60), straight);
  EXPECT_EQ(other->statistics().impacts, driver->statistics().impacts);
  EXPECT_EQ(other->statistics().steps, driver->statistics().steps);
  EXPECT_GT(driver->statistics().impacts, 0);
  EXPECT_THROW(other->restore(std::span(snapshot).first(8)), Error);
  EXPECT_EQ(other->save(), driver->save());
}

TEST(Precise, WrittenStatesTakeEffect) {
  Scene scene = rods(1);
  scene.bodies.push_back({.name = "free", .inertia = 1});
  const auto driver = make_precise_driver(scene, {}, {});
  advance(*driver, 2, 10);
  driver->write(0, {{0, -0.5}, -kPi / 2, {}, 0});
  driver->write(1, {{1, 1}, 0, {2, 0}, 0});
  const auto states = advance(*driver, 2, 60);
  EXPECT_NEAR(states[0].position.y, -0.5, 1e-14);  // hangs at rest
  EXPECT_NEAR(states[0].velocity.x, 0, 1e-11);     // of 3 m/s: some steps' share of the tolerance
  EXPECT_NEAR(states[1].position.x, 3, 1e-14);
  EXPECT_NEAR(states[1].position.y, 1 - 9.81 / 2, 1e-13);
}

TEST(PrecisePlan, NamesWhatRunsAndWhy) {
  const auto is_active = [](const Driver& driver, const std::string& name) {
    for (const Stage& stage : driver.plan().stages) {
      if (stage.name == name) return stage.active;
    }
    ADD_FAILURE() << "no stage " << name;
    return false;
  };
  Scene fall{.name = "fall"};
  fall.bodies = {ball("a", {})};
  const auto falling = make_precise_driver(fall, {}, {});
  EXPECT_EQ(falling->plan().driver, "precise");
  EXPECT_TRUE(is_active(*falling, "polynomial_flight"));
  for (const char* stage :
       {"runge_kutta", "joint_accelerations", "projection", "contact_search", "contacts", "forces"}) {
    EXPECT_FALSE(is_active(*falling, stage)) << stage;
  }
  const auto swinging = make_precise_driver(rods(2), {}, {});
  EXPECT_TRUE(is_active(*swinging, "runge_kutta"));
  EXPECT_TRUE(is_active(*swinging, "joint_accelerations"));
  EXPECT_TRUE(is_active(*swinging, "projection"));
  EXPECT_FALSE(is_active(*swinging, "polynomial_flight"));
  swinging->profile(true);
  advance(*swinging, 2, 5);
  for (const Stage& stage : swinging->plan().stages)
    EXPECT_EQ(stage.nanoseconds > 0, stage.active) << stage.name;
}

TEST(PrecisePlan, EveryStageGivesTheSameBits) {
  Scene discs{.name = "discs"};
  discs.bodies = {ball("a", {0, 0}, {2, 0.1}), ball("b", {3, 0})};
  Scene mixed = rods(2);
  mixed.bodies.push_back({.name = "free", .inertia = 1});
  Scene drag{.name = "drag"};
  drag.bodies = {{.name = "ball", .velocity = {2, 1}, .inertia = 1}};
  drag.forces = {QuadraticDrag{"ball", 0.3}};
  for (const Scene& scene : {discs, rods(3), mixed, drag}) {
    const auto all = make_precise_driver(scene, {}, {.every_stage = true});
    for (const Stage& stage : all->plan().stages) EXPECT_TRUE(stage.active);
    EXPECT_EQ(advance(*all, scene.bodies.size(), 120), run(scene, 120)) << scene.name;
  }
}

}  // namespace
}  // namespace plumb
