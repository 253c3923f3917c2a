#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "tests/precise/support.h"

namespace plumb {
namespace {

Precise symplectic(double tolerance, double max_dt) {
  return {.tolerance = tolerance, .max_dt = max_dt, .method = MotionMethod::Symplectic};
}

/// mu = 1, e = 0.6 from the pericentre: a = 1, period 2 pi, energy -1/2, angular momentum 0.8.
Scene kepler() {
  Scene scene{.name = "kepler", .gravity = {0, 0}};
  scene.bodies = {{.name = "planet", .position = {0.4, 0}, .velocity = {0, 2}, .inertia = 1}};
  scene.forces = {AttractionForce{.body = "planet", .strength = 1}};
  return scene;
}

TEST(PreciseLong, KeplersEnergyDoesNotDriftInAThousandPeriods) {
  const auto driver = make_precise_driver(kepler(), symplectic(1e-6, 2 * kPi / 10), {});
  double first = 0, last = 0;
  for (int period = 0; period < 1000; ++period) {
    for (int i = 0; i < 10; ++i) {
      const BodyState s = advance(*driver, 1, 1)[0];
      const double error =
          std::abs(length_squared(s.velocity) / 2 - 1 / std::sqrt(length_squared(s.position)) + 0.5);
      if (period < 100) first = std::max(first, error);
      if (period >= 900) last = std::max(last, error);
      EXPECT_NEAR(cross(s.position, s.velocity), 0.8, 1e-13);
    }
  }
  EXPECT_LT(first, 1.5e-9);
  EXPECT_LT(last, 1.05 * first);
  // The adaptive method meets its tolerance too, but what it loses adds up.
  const auto adaptive = make_precise_driver(kepler(), {.tolerance = 1e-6, .max_dt = 2 * kPi}, {});
  const BodyState s = advance(*adaptive, 1, 1000)[0];
  EXPECT_GT(std::abs(length_squared(s.velocity) / 2 - 1 / std::sqrt(length_squared(s.position)) + 0.5), 1e-7);
}

TEST(PreciseLong, PendulumsEnergyDoesNotDriftInTenThousandPeriods) {
  // A rod from the horizontal: T = 2 pi sqrt(2 / (3 g)) 1.18034059901610.
  const double period = 2 * kPi * std::sqrt(2 / (3 * 9.81)) * 1.18034059901610;
  const auto driver = make_precise_driver(rods(1), symplectic(1e-3, 10.3 * period), {});
  double first = 0, last = 0;
  constexpr int kLooks = 971;  // 10001 periods
  for (int i = 0; i < kLooks; ++i) {
    const RodsCheck now = check_rods(advance(*driver, 1, 1));
    if (i < kLooks / 10) first = std::max(first, std::abs(now.energy));
    if (i > kLooks - kLooks / 10) last = std::max(last, std::abs(now.energy));
    EXPECT_LT(now.gap, 1e-15);
  }
  EXPECT_LT(first, 1e-4);  // of 4.9 J
  EXPECT_LT(last, 1.1 * first);
}

TEST(PreciseLong, SymplecticStepsMeetTheToleranceAsWell) {
  double before = 1;
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    const auto states = run(rods(2), 60, symplectic(tolerance, 1.0 / 60));
    const Vec2d tip = rod_end(states.back(), 0.5);
    const double error = std::sqrt(length_squared(tip - Vec2d{-1.66211513581613, -1.04146663719322}));
    EXPECT_LT(error, before / 30) << tolerance;
    before = error;
  }
  EXPECT_LT(before, 1e-8);
}

TEST(PreciseLong, SymplecticStepsDoNotDependOnHowOftenTheyAreLookedAt) {
  const auto seldom = make_precise_driver(rods(2), symplectic(1e-6, 0.5), {});
  const auto often = make_precise_driver(rods(2), symplectic(1e-6, 0.5 / 64), {});
  for (int half = 1; half <= 4; ++half) {
    for (int i = 0; i < 63; ++i) advance(*often, 2, 1);
    EXPECT_EQ(advance(*often, 2, 1), advance(*seldom, 2, 1)) << half;
  }
  const auto other = make_precise_driver(rods(2), symplectic(1e-6, 0.5), {});
  other->restore(seldom->save());
  EXPECT_EQ(advance(*other, 2, 5), advance(*seldom, 2, 5));
}

TEST(PreciseLong, WhatTheSymplecticMethodIsNotForIsRefused) {
  Scene braked = kepler();
  braked.forces.push_back(LinearDrag{"planet", 0.1});
  Scene damped = kepler();
  damped.forces = {SpringForce{.body_a = "world", .body_b = "planet", .stiffness = 1, .damping = 0.1}};
  Scene discs{.name = "discs"};
  discs.bodies = {ball("a", {0, 0}), ball("b", {3, 0})};
  for (const Scene& scene : {braked, damped, discs}) {
    EXPECT_EQ(unsupported(scene, Precise{}), "");
    EXPECT_NE(unsupported(scene, symplectic(1e-6, 0.1)), "");
    EXPECT_THROW(compile(scene, symplectic(1e-6, 0.1)), Error);
  }
  EXPECT_EQ(unsupported(kepler(), symplectic(1e-6, 0.1)), "");
}

}  // namespace
}  // namespace plumb
