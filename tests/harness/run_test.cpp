#include "harness/run.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "tests/harness/fakes.h"

namespace plumb::harness {
namespace {

using namespace fakes;
using reference::Scheme;

constexpr double kDt = 1.0 / 60;

Result run_fake(const scenarios::Problem& problem, Motion motion,
                reference::Method how = method(Scheme::SemiImplicitEuler, 1)) {
  const scenarios::Scenario scenario = family([&] { return problem; });
  const Case scene_case({&scenario, "", 1}, kDt);
  return run(scene_case, FakeBackend("fake", std::move(motion), how), {});
}

bool passes(const Result& result, std::string_view name) {
  const Check* check = result.find_check(name);
  EXPECT_NE(check, nullptr) << name;
  return check != nullptr && check->pass;
}

TEST(Run, AnExactRunHasNoErrorsAndPassesAllChecks) {
  const Result result = run_fake(thrown(), exactly(thrown()));
  EXPECT_EQ(result.status, Status::Ok);
  EXPECT_EQ(result.metrics.position_error, 0);
  EXPECT_EQ(result.metrics.angle_error, 0);
  EXPECT_EQ(result.metrics.velocity_error, 0);
  EXPECT_LT(*result.metrics.energy_drift, 1e-14);
  EXPECT_EQ(result.metrics.momentum_drift, 0);
  EXPECT_FALSE(result.metrics.angular_momentum_drift);  // gravity changes it
  EXPECT_FALSE(result.metrics.joint_gap);
  EXPECT_FALSE(result.metrics.penetration);
  EXPECT_EQ(result.checks.size(), 7u);
  for (const Check& check : result.checks) EXPECT_TRUE(check.pass) << check.name;
  EXPECT_EQ(result.settings, (reference::Settings{{"fake", "yes"}}));
}

TEST(Run, ErrorsAreTheLargestOverTheRunAndAllBodies) {
  const scenarios::Problem problem = thrown();
  // Off at one sample alone, in the middle: 3-4-5 triangles, so that the lengths are known.
  const Result result =
      run_fake(problem, [exact = exactly(problem)](long step, double dt, std::span<BodyState> out) {
        exact(step, dt, out);
        if (step != 40) return;
        out[0].position += {0.03, 0.04};
        out[0].velocity += {0.6, -0.8};
        out[0].angle -= 0.25;
        out[0].angular_velocity += 0.125;
      });
  EXPECT_NEAR(*result.metrics.position_error, 0.05, 1e-14);
  EXPECT_NEAR(*result.metrics.velocity_error, 1, 1e-14);
  EXPECT_NEAR(*result.metrics.angle_error, 0.25, 1e-14);
  EXPECT_NEAR(*result.metrics.angular_velocity_error, 0.125, 1e-14);
}

TEST(Run, DriftIsRelativeToTheLargestEnergyAndMomentum) {
  scenarios::Problem problem = thrown();
  problem.scene.gravity = {0, 0};
  problem.conserved = {.energy = true, .momentum_x = true, .momentum_y = true, .angular_momentum = true};
  problem.truth.exact = [](double t, std::span<BodyState> out) {
    out[0] = {{1 + 3 * t, 2 + 4 * t}, 2 * t, {3, 4}, 2};
  };
  // 10 % faster, 25 % more spin: kinetic energy 2*25/2 + 0.5*4/2 = 26 becomes 30.25 + 1.5625; momentum off by
  // a tenth.
  const Result result =
      run_fake(problem, [exact = exactly(problem)](long step, double dt, std::span<BodyState> out) {
        exact(step, dt, out);
        out[0].velocity *= 1.1;
        out[0].angular_velocity *= 1.25;
      });
  EXPECT_NEAR(*result.metrics.energy_drift, 5.8125 / 26, 1e-14);
  EXPECT_NEAR(*result.metrics.momentum_drift, 0.1, 1e-14);
  // L = m (1*4 - 2*3) + I w = -4 + 1 becomes -4.4 + 1.25; the largest |m x * v| + |I w| is 4 + 1.
  EXPECT_NEAR(*result.metrics.angular_momentum_drift, 0.15 / 5, 1e-13);
  EXPECT_FALSE(passes(result, "momentum_drift"));
}

TEST(Run, GravityIsPartOfTheEnergy) {
  const scenarios::Problem problem = thrown();
  // A body that stays where it is while its speed follows the throw loses what the truth stores in height.
  const Result result =
      run_fake(problem, [exact = exactly(problem)](long step, double dt, std::span<BodyState> out) {
        exact(step, dt, out);
        out[0].position.y = 2;
      });
  // At t = 2: the height gained is 8 - 2*9.81 = -11.62 m; m g h over the scale, 26 + m g (largest fall).
  EXPECT_NEAR(*result.metrics.energy_drift, 2 * 9.81 * 11.62 / (26 + 2 * 9.81 * 11.62), 1e-12);
}

TEST(Run, SamplesNextToAnImpactAreLeftOutOfVelocityErrorsAlone) {
  scenarios::Problem problem = thrown();
  problem.scene.gravity = {0, 0};
  problem.conserved = {};
  problem.truth.exact = [](double t, std::span<BodyState> out) {
    out[0] = t < 1.001 ? BodyState{{t, 0}, 0, {1, 0}, 0} : BodyState{{2.002 - t, 0}, 0, {-1, 0}, 0};
  };
  problem.scene.bodies[0].position = {0, 0};
  problem.scene.bodies[0].velocity = {1, 0};
  problem.scene.bodies[0].angular_velocity = 0;
  problem.truth.impacts = {1.001};
  const auto late_by = [](double delay) {
    return [delay](long step, double dt, std::span<BodyState> out) {
      const double t = static_cast<double>(step) * dt, turn = 1.001 + delay;
      out[0] = t < turn ? BodyState{{t, 0}, 0, {1, 0}, 0} : BodyState{{2 * turn - t, 0}, 0, {-1, 0}, 0};
    };
  };
  const Result late = run_fake(problem, late_by(kDt));
  EXPECT_NEAR(*late.metrics.velocity_error, 0, 1e-14);
  EXPECT_NEAR(*late.metrics.position_error, 2 * kDt, 1e-12);
  EXPECT_TRUE(passes(late, "position_error"));
  EXPECT_TRUE(passes(late, "velocity_error"));
  const Result later = run_fake(problem, late_by(2.1 * kDt));
  EXPECT_NEAR(*later.metrics.velocity_error, 2, 1e-14);
  EXPECT_FALSE(passes(later, "position_error"));
  EXPECT_FALSE(passes(later, "velocity_error"));
}

TEST(Run, StatesThatAreNotFiniteOrFarOffHaveDiverged) {
  const scenarios::Problem problem = thrown();
  const auto broken_from = [&](double value) {
    return [exact = exactly(problem), value](long step, double dt, std::span<BodyState> out) {
      exact(step, dt, out);
      if (step >= 30) out[0].position.x = value;
    };
  };
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e6}) {
    const Result result = run_fake(problem, broken_from(value));
    EXPECT_EQ(result.status, Status::Diverged);
    EXPECT_NE(result.reason.find("'ball'"), std::string::npos) << result.reason;
    EXPECT_NE(result.reason.find("0.5 s"), std::string::npos) << result.reason;
    EXPECT_FALSE(passes(result, "finite"));
  }
  const Result off =
      run_fake(problem, broken_from(1000));  // wrong, but not a thousand times the scene's extent
  EXPECT_EQ(off.status, Status::Ok);
  EXPECT_FALSE(passes(off, "position_error"));
}

TEST(Run, TheDiscreteOracleKnowsTheScheme) {
  scenarios::Problem problem = thrown();
  // Semi-implicit Euler: v_n = v0 + n h g, x_n = x0 + n h v0 + g h^2 n (n + 1)/2.
  const auto discrete = [](Scheme scheme, double h, long steps, std::span<BodyState> out) {
    if (scheme != Scheme::SemiImplicitEuler) return false;
    const double n = static_cast<double>(steps), t = n * h;
    out[0] = {{1 + 3 * t, 2 + 4 * t - 9.81 * h * h * n * (n + 1) / 2}, 2 * t, {3, 4 - 9.81 * t}, 2};
    return true;
  };
  problem.truth.discrete = discrete;
  const auto stepped = [](double sign) {
    return [sign](long step, double h, std::span<BodyState> out) {
      const double n = static_cast<double>(step), t = n * h;
      out[0] = {{1 + 3 * t, 2 + 4 * t - 9.81 * h * h * n * (n + sign) / 2}, 2 * t, {3, 4 - 9.81 * t}, 2};
    };
  };
  EXPECT_TRUE(passes(run_fake(problem, stepped(1)), "discrete_position"));
  const Result wrong =
      run_fake(problem, stepped(-1));  // explicit Euler: as near to the truth, but not this scheme
  EXPECT_TRUE(passes(wrong, "position_error"));
  EXPECT_FALSE(passes(wrong, "discrete_position"));
  const Result other = run_fake(problem, stepped(-1), method(Scheme::ExplicitEuler, 1));
  EXPECT_EQ(other.find_check("discrete_position"), nullptr);
}

TEST(Run, WhatAnEngineCannotDoIsSkipped) {
  const scenarios::Scenario scenario = family(thrown);
  const Case scene_case({&scenario, "", 1}, kDt);
  FakeBackend backend("fake", exactly(thrown()));
  backend.unsupported_ = "it has no circles";
  EXPECT_EQ(run(scene_case, backend, {}).status, Status::Skipped);
  EXPECT_EQ(run(scene_case, backend, {}).reason, "it has no circles");
  backend.identity_.available = false;
  backend.identity_.reason = "install libfake-dev";
  EXPECT_EQ(run(scene_case, backend, {}).reason, "not installed: install libfake-dev");
}

TEST(Run, TheScaleIsThatOfTheTruth) {
  const TruthTable truth(thrown(), kDt);
  const Scale& scale = truth.scale();
  // x from 1 to 7, y from its top 2 + 4^2/(2 g) to 2 + 8 - 2 g, each half a metre more for the disc.
  EXPECT_NEAR(scale.length, 9.62, 1e-12);
  EXPECT_NEAR(scale.extent, std::hypot(7, 16 / (2 * 9.81) + 11.62 + 1), 1e-3);
  EXPECT_NEAR(scale.speed, std::hypot(3, 4 - 2 * 9.81), 1e-12);
  EXPECT_NEAR(scale.angle, 4, 1e-12);
  EXPECT_EQ(scale.angular_speed, 2);
  EXPECT_EQ(truth.steps(), 120);
}

TEST(Run, ATruthIsNotNeeded) {
  scenarios::Problem problem = thrown();
  const Motion motion = exactly(problem);
  problem.truth = {};
  const Result result = run_fake(problem, motion);
  EXPECT_EQ(result.status, Status::Ok);
  EXPECT_FALSE(result.metrics.position_error);
  EXPECT_TRUE(result.metrics.energy_drift);
  EXPECT_TRUE(passes(result, "finite"));
}

}  // namespace
}  // namespace plumb::harness
