#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/precise/support.h"
#include "tests/precise/truth.h"

namespace plumb {
namespace {

using truth::Real;

constexpr Precise kImplicit{.tolerance = 1e-9, .max_dt = 1.0 / 60, .method = MotionMethod::Implicit};

/// A body in treacle (time constant 1e-5 s) and one in thin air (3.3 s).
Scene fast_and_slow_drag() {
  Scene scene{.name = "drag"};
  scene.bodies = {{.name = "fast", .velocity = {3, 5}, .inertia = 1},
                  {.name = "slow", .velocity = {3, 5}, .inertia = 1}};
  scene.forces = {LinearDrag{"fast", 1e5}, LinearDrag{"slow", 0.3}};
  return scene;
}

TEST(PreciseStiff, FastDragBesideASlowOneCostsWhatTheSlowOneDoes) {
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    const auto driver = make_precise_driver(fast_and_slow_drag(), {.tolerance = tolerance}, {});
    const auto s = advance(*driver, 2, 60);
    const Real t = driver->time(), k = 0.3L, decay = std::exp(-k * t), u = -9.81L / k;
    const Real terminal = -9.81L / 1e5L, relaxation = 1e-5L;
    EXPECT_NEAR(s[1].velocity.y, static_cast<double>((5 - u) * decay + u), 1e-3 * tolerance);
    EXPECT_NEAR(s[1].position.y, static_cast<double>((5 - u) * (1 - decay) / k + u * t), 1e-3 * tolerance);
    EXPECT_NEAR(s[0].velocity.y, static_cast<double>(terminal), 1e-3 * tolerance);
    EXPECT_NEAR(s[0].position.y, static_cast<double>((5 - terminal) * relaxation + terminal * t),
                1e-3 * tolerance);
    const Statistics statistics = driver->statistics();
    EXPECT_GT(statistics.implicit, 0);
    EXPECT_LT(statistics.evaluations, 2000);  // the explicit method takes 190000
  }
}

TEST(PreciseStiff, ImplicitChainsHaveTheirPublishedTips) {
  for (const auto& [n, expected] : {std::pair{2, Vec2d{-1.66211513581613, -1.04146663719322}},
                                    std::pair{5, Vec2d{0.533569475142432, -4.91970959757084}}}) {
    const auto driver = make_precise_driver(rods(n), kImplicit, {});
    const auto states = advance(*driver, n, 60);
    const Vec2d tip = rod_end(states.back(), 0.5);
    EXPECT_NEAR(tip.x, expected.x, 3e-13);
    EXPECT_NEAR(tip.y, expected.y, 3e-13);
    EXPECT_LT(check_rods(states).gap, 3e-14);
    EXPECT_EQ(driver->statistics().implicit, driver->statistics().steps);
  }
}

TEST(PreciseStiff, NeitherMethodIsTakenWithoutNeed) {
  const auto chain = make_precise_driver(rods(5), {}, {});
  advance(*chain, 5, 60);
  EXPECT_EQ(chain->statistics().implicit, 0);
  const auto forced =
      make_precise_driver(fast_and_slow_drag(), {.tolerance = 1e-2, .method = MotionMethod::Explicit}, {});
  advance(*forced, 2, 1);
  EXPECT_EQ(forced->statistics().implicit, 0);
}

TEST(PreciseStiff, DistanceJointSwingsByItsEllipticPeriod) {
  // As in the explicit test: T/T0 = 1.18034059901610 at 90 degrees.
  Scene scene{.name = "pendulum", .gravity = {0, -10}};
  scene.bodies = {{.name = "bob", .position = {1, 0}, .inertia = 1}};
  scene.joints = {DistanceJoint{"string", std::string(kWorld), "bob", {}, {}, 1, false}};
  const double period = 2 * kPi * std::sqrt(1.0 / 10) * 1.18034059901610;
  const BodyState s = run(scene, 100, {.max_dt = period / 100, .method = MotionMethod::Implicit})[0];
  EXPECT_NEAR(s.position.x, 1, 1e-12);
  EXPECT_NEAR(s.position.y, 0, 1e-10);
}

TEST(PreciseStiff, RedundantJointsDoNoHarm) {
  Scene doubled = rods(3);
  for (int i = 0; i < 3; ++i) {
    RevoluteJoint again = std::get<RevoluteJoint>(doubled.joints[i]);
    again.name += " again";
    doubled.joints.push_back(again);
  }
  const auto once = run(rods(3), 30, kImplicit), twice = run(doubled, 30, kImplicit);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(once[i].angle, twice[i].angle, 1e-11);
}

TEST(PreciseStiff, SavedAndRestoredRunsGoOnWithTheSameBits) {
  Scene scene = rods(2);
  scene.bodies.push_back({.name = "fast", .velocity = {3, 5}, .inertia = 1});
  scene.forces = {LinearDrag{"fast", 1e6}};
  for (const Precise& precise : {kImplicit, Precise{}}) {
    const auto driver = make_precise_driver(scene, precise, {});
    advance(*driver, 3, 20);
    EXPECT_GT(driver->statistics().implicit, 0);
    const auto snapshot = driver->save();
    const auto straight = advance(*driver, 3, 40);
    const auto other = make_precise_driver(scene, precise, {});
    other->restore(snapshot);
    EXPECT_EQ(advance(*other, 3, 40), straight);
    EXPECT_EQ(other->save(), driver->save());
  }
}

/// A spring of k/m = 1e10 beside one of k/m = 10, both damped: x = 1 + 0.1 e^(-b t) (cos w t + b/w sin w t).
Scene fast_and_slow_springs() {
  Scene scene{.name = "springs", .gravity = {0, 0}};
  for (const auto& [name, y] : {std::pair{"fast", 0.0}, std::pair{"slow", 5.0}}) {
    scene.bodies.push_back({.name = name, .position = {1.1, y}, .inertia = 1, .fixed_rotation = true});
  }
  scene.forces = {
      SpringForce{.body_a = "world", .body_b = "fast", .rest_length = 1, .stiffness = 1e10, .damping = 1e4},
      SpringForce{.body_a = "world",
                  .body_b = "slow",
                  .anchor_a = {0, 5},
                  .rest_length = 1,
                  .stiffness = 10,
                  .damping = 0.5}};
  return scene;
}

TEST(PreciseStiff, FastSpringBesideASlowOneCostsWhatTheSlowOneDoes) {
  for (const MotionMethod method : {MotionMethod::Automatic, MotionMethod::Implicit}) {
    for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
      const auto driver =
          make_precise_driver(fast_and_slow_springs(), {.tolerance = tolerance, .method = method}, {});
      for (int tenth = 1; tenth <= 10; ++tenth) {
        const BodyState s = advance(*driver, 2, 6)[1], fast = advance(*driver, 2, 0)[0];
        const Real t = driver->time(), b = 0.25L, w = std::sqrt(10 - b * b);
        const Real x = 1 + 0.1L * std::exp(-b * t) * (std::cos(w * t) + b / w * std::sin(w * t));
        EXPECT_NEAR(s.position.x, static_cast<double>(x), 0.1 * tolerance);
        EXPECT_NEAR(fast.position.x, 1, 1e-3 * tolerance + 1e-15);
      }
      EXPECT_GT(driver->statistics().implicit, 0);
      EXPECT_LT(driver->statistics().evaluations, 25000);  // the explicit method takes 220000 at the least
    }
  }
}

}  // namespace
}  // namespace plumb
