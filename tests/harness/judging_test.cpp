// Figures and bounds that are no numbers, and what is a little beyond its bound: none may pass.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "harness/check.h"
#include "harness/compare.h"
#include "harness/stress/rules.h"
#include "harness/track.h"
#include "tests/harness/fakes.h"

namespace plumb::harness {
namespace {

using namespace fakes;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();

Check checked(std::initializer_list<std::pair<double, double>> values_and_bounds) {
  WorstRatio worst;
  for (const auto& [value, bound] : values_and_bounds) worst.add(value, bound);
  return worst.check("figure", Oracle::Exact);
}

TEST(Judging, ACheckPassesUpToItsBound) {
  EXPECT_TRUE(checked({{1, 1}}).pass);
  EXPECT_TRUE(checked({{0, 0}}).pass);
  EXPECT_FALSE(checked({{1.02, 1}}).pass);
  EXPECT_FALSE(checked({{1e-300, 0}}).pass);
  EXPECT_FALSE(checked({{0.5, 1}, {1.02, 1}, {0.5, 1}}).pass) << "one sample is enough";
}

TEST(Judging, ACheckOfWhatIsNoNumberFailsAndShowsIt) {
  for (const auto& samples : {std::pair{kNaN, 1.0}, std::pair{0.0, kNaN}, std::pair{1.0, kNaN},
                              std::pair{kNaN, kNaN}, std::pair{kInfinity, 1.0}, std::pair{0.0, -1.0}}) {
    for (const bool last : {false, true}) {
      const Check check = last ? checked({{0.9, 1}, samples}) : checked({samples, {0.9, 1}});
      EXPECT_FALSE(check.pass) << samples.first << " of " << samples.second;
      EXPECT_TRUE(check.value != 0.9) << "the sample that failed is the one that is shown";
    }
  }
}

TEST(Judging, AnUnexpectedFigureThatIsNoNumberFailsTheRun) {
  Result result;
  result.engine = "some", result.label = "thing";
  result.checks = {checked({{0.5, kNaN}})};
  judge(result, true, {});
  EXPECT_EQ(result.unexpected.size(), 1u);
  const Result read = result_from_json(to_json(result));  // as from a run in a process of its own
  EXPECT_FALSE(read.checks[0].pass);
  EXPECT_TRUE(std::isnan(read.checks[0].tolerance));
}

// ---- Agreement

struct Tracks {
  Tracks(double apart, double turned, Track::Point bounds = {0, 0, 0, 0.1, 0.2}) : a(2, 1), b(2, 1) {
    for (int sample = 0; sample < 3; ++sample) {
      a.put(sample, 0, {1, 2, 3, bounds.bound, bounds.angle_bound});
      b.put(sample, 0,
            sample == 1 ? Track::Point{1 + apart, 2, 3 + turned, 2 * bounds.bound, 2 * bounds.angle_bound}
                        : Track::Point{1, 2, 3, bounds.bound, bounds.angle_bound});
    }
  }
  bool agree() const {
    const auto one = a.worst_difference(b), other = b.worst_difference(a);
    EXPECT_TRUE(one && other);
    EXPECT_EQ(one && one->agrees(), other && other->agrees());
    return one && one->agrees();
  }
  Track a, b;
};

TEST(Judging, EnginesAgreeUpToTheSumOfTheirBounds) {
  EXPECT_TRUE(Tracks(0.98 * 0.3, 0).agree());
  EXPECT_FALSE(Tracks(1.02 * 0.3, 0).agree());
  EXPECT_TRUE(Tracks(0, 0.98 * 0.6).agree());
  EXPECT_FALSE(Tracks(0, 1.02 * 0.6).agree());
  EXPECT_TRUE(Tracks(0, 0, {0, 0, 0, 0, 0}).agree());
  EXPECT_FALSE(Tracks(1e-15, 0, {0, 0, 0, 0, 0}).agree());
}

TEST(Judging, WhatIsNoNumberAgreesWithNothing) {
  EXPECT_FALSE(Tracks(kNaN, 0).agree());
  EXPECT_FALSE(Tracks(0, kNaN).agree());
  EXPECT_FALSE(Tracks(0, 0, {0, 0, 0, kNaN, 1}).agree());
  EXPECT_FALSE(Tracks(0, 0, {0, 0, 0, 1, kNaN}).agree());
  EXPECT_FALSE(Tracks(kInfinity, 0).agree());
}

TEST(Judging, WithoutABoundNobodyAgreesOrDisagrees) {
  const Tracks tracks(1e9, 0, {0, 0, 0, -1, -1});
  EXPECT_FALSE(tracks.a.worst_difference(tracks.b));
}

// Engines that are off by a share of their bound, one each way: whether they agree is known beforehand.
TEST(Judging, AnEngineBesideTheTruthAgreesAsFarAsBothBoundsReach) {
  scenarios::Problem problem = thrown();
  problem.precise = {.position = 1e-3, .angle = 1e-3};
  const auto off = [&](double by) {
    return [exact = exactly(problem), by](long step, double dt, std::span<BodyState> out) {
      exact(step, dt, out);
      out[0].position.x += by;
    };
  };
  const auto adaptive = method(reference::Scheme::Adaptive, 0);
  const scenarios::Scenario scenario = family([&] { return problem; });
  FakeBackend left("left", off(-0.98e-3), adaptive), right("right", off(0.98e-3), adaptive),
      beyond("beyond", off(1.06e-3), adaptive);
  const CompareOptions options{
      .instances = {{&scenario, "", 1}}, .engines = {&left, &right, &beyond}, .measure_cost = false};
  const std::vector<Result> results = compare_on(options.instances[0], options);
  EXPECT_EQ(results[0].agrees_with, std::vector<std::string>{"right"});
  EXPECT_EQ(results[0].disagrees_with, std::vector<std::string>{"beyond"});
  EXPECT_EQ(results[1].agrees_with, (std::vector<std::string>{"left", "beyond"}));
  EXPECT_TRUE(results[0].unexpected.empty());
  EXPECT_EQ(results[2].unexpected.size(), 1u);
}

// ---- Runs

Result run_fake(const scenarios::Problem& problem, Motion motion) {
  const scenarios::Scenario scenario = family([&] { return problem; });
  const Case scene_case({&scenario, "", 1}, 1.0 / 60);
  return run(scene_case,
             FakeBackend("fake", std::move(motion), method(reference::Scheme::SemiImplicitEuler, 1)), {});
}

// Speeds whose squares are beyond what a double holds: at 2e154 m/s, one way and the other, energies are
// infinite and their difference is no number.
TEST(Judging, AnEnergyThatIsNoNumberFails) {
  scenarios::Problem problem = thrown();
  problem.truth.exact = nullptr;
  const Result result =
      run_fake(problem, [exact = exactly(thrown())](long step, double dt, std::span<BodyState> out) {
        exact(step, dt, out);
        if (step == 40) out[0].velocity.x = 1e200;
        if (step == 40) out[0].angular_velocity = 1e200;
      });
  const Check* check = result.find_check("energy_drift");
  EXPECT_FALSE(result.metrics.energy_drift && std::isfinite(*result.metrics.energy_drift));
  EXPECT_TRUE(check == nullptr || !check->pass);
}

TEST(Judging, ATruthThatIsNoNumberPassesNobody) {
  scenarios::Problem problem = thrown();
  for (double BodyState::*member : {&BodyState::angle, &BodyState::angular_velocity}) {
    problem.truth.exact = [exact = thrown().truth.exact, member](double t, std::span<BodyState> out) {
      exact(t, out);
      if (std::abs(t - 1) < 1e-9) out[0].*member = kNaN;
    };
    const Result result = run_fake(problem, exactly(thrown()));
    bool passed = true;
    for (const Check& check : result.checks) passed = passed && check.pass;
    EXPECT_FALSE(passed);
    const auto& metric =
        member == &BodyState::angle ? result.metrics.angle_error : result.metrics.angular_velocity_error;
    EXPECT_TRUE(metric && std::isnan(*metric)) << "one sample that is no number is not forgotten";
  }
}

// ---- Maps of the extremes

TEST(Judging, ARuleOfWhatIsNoNumberIsNotOk) {
  const stress::Rule rule{.measure = "figure", .bound = 1};
  EXPECT_EQ(stress::grade(rule, 1), stress::Verdict::Ok);
  EXPECT_EQ(stress::grade(rule, 1.02), stress::Verdict::Inaccurate);
  EXPECT_EQ(stress::grade(rule, kNaN), stress::Verdict::Explodes);
  stress::Rule without = rule;
  without.bound = kNaN;
  for (const double figure : {0.0, 1.0, kNaN}) EXPECT_NE(stress::grade(without, figure), stress::Verdict::Ok);
}

}  // namespace
}  // namespace plumb::harness
