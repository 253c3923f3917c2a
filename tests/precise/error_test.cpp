#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "tests/precise/support.h"
#include "tests/precise/truth.h"

// The error that Precise estimates for itself, against the true one.
namespace plumb {
namespace {

using truth::Real;

constexpr int kSamples = 10;

/// Runs for `duration` with an estimate; the largest true error of a position at the samples.
struct Outcome {
  double estimated = 0, actual = 0;
};
Outcome run_with_estimate(const Scene& scene, double duration, double tolerance,
                          const std::function<std::vector<Vec2d>(int sample)>& positions) {
  Simulation simulation =
      compile(scene, Precise{.tolerance = tolerance, .max_dt = duration / kSamples, .estimate_error = true});
  Outcome outcome;
  for (int i = 1; i <= kSamples; ++i) {
    simulation.step();
    const std::vector<Vec2d> exact = positions(i);
    for (std::size_t body = 0; body < exact.size(); ++body) {
      outcome.actual =
          std::max(outcome.actual, std::sqrt(length_squared(simulation.state(body).position - exact[body])));
    }
  }
  EXPECT_TRUE(simulation.statistics().error.known);
  outcome.estimated = simulation.statistics().error.position;
  return outcome;
}

void expect_within_a_decade(const Outcome& outcome, const std::string& what) {
  EXPECT_GT(outcome.estimated, outcome.actual / 10) << what;
  EXPECT_LT(outcome.estimated, outcome.actual * 10) << what;
}

TEST(PreciseError, OfChainsIsWithinADecade) {
  for (int n = 1; n <= 5; ++n) {
    std::vector<std::vector<Vec2d>> exact(1);
    std::vector<Real> y(static_cast<std::size_t>(2 * n), 0);
    for (int sample = 0; sample < kSamples; ++sample) {
      y = truth::integrate_twice(truth::chain_of_rods(n, 9.81L), y, 0, 1.0L / kSamples, 1000);
      std::vector<Vec2d> centres;
      Real x = 0, height = 0;
      for (int i = 0; i < n; ++i) {
        const Real c = std::cos(y[i]) / 2, s = std::sin(y[i]) / 2;
        centres.push_back({static_cast<double>(x + c), static_cast<double>(height + s)});
        x += 2 * c, height += 2 * s;
      }
      exact.push_back(centres);
    }
    for (const double tolerance : {1e-1, 1e-3, 1e-5, 1e-7}) {
      expect_within_a_decade(
          run_with_estimate(rods(n), 1, tolerance, [&](int sample) { return exact[sample]; }),
          std::to_string(n) + " rods at " + std::to_string(tolerance));
    }
  }
}

TEST(PreciseError, OfDragIsWithinADecade) {
  // y = -(v^2/g) ln cosh(g t/v), v the terminal speed.
  Scene scene{.name = "drag"};
  scene.bodies = {{.name = "drop", .mass = 1, .inertia = 1}};
  scene.forces = {QuadraticDrag{"drop", 2}};
  const Real v = std::sqrt(9.81L / 2);
  for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
    expect_within_a_decade(
        run_with_estimate(scene, 2, tolerance,
                          [&](int i) {
                            const Real t = 2.0L * i / kSamples;
                            return std::vector<Vec2d>{
                                {0,
                                 static_cast<double>(-v * v / 9.81L * std::log(std::cosh(9.81L * t / v)))}};
                          }),
        "drag at " + std::to_string(tolerance));
  }
}

TEST(PreciseError, OfKeplersEllipseIsWithinADecade) {
  // e = 0.6, mu = 1 from the pericentre: E - e sin E = t, place (cos E - e, 0.8 sin E).
  Scene scene{.name = "kepler", .gravity = {}};
  scene.bodies = {{.name = "planet", .position = {0.4, 0}, .velocity = {0, 2}, .inertia = 1}};
  scene.forces = {AttractionForce{.body = "planet", .strength = 1}};
  const auto place = [](int i) {
    const Real t = 2 * 3.14159265358979323846L * i / kSamples;
    Real e = t;
    for (int k = 0; k < 60; ++k) e -= (e - 0.6L * std::sin(e) - t) / (1 - 0.6L * std::cos(e));
    return std::vector<Vec2d>{
        {static_cast<double>(std::cos(e) - 0.6L), static_cast<double>(0.8L * std::sin(e))}};
  };
  for (const double tolerance : {1e-1, 1e-3, 1e-5, 1e-7}) {
    expect_within_a_decade(run_with_estimate(scene, 2 * kPi, tolerance, place),
                           "kepler at " + std::to_string(tolerance));
  }
}

TEST(PreciseError, EstimatingChangesNothingAndIsRestored) {
  Simulation plain = compile(rods(3), Precise{});
  Simulation watched = compile(rods(3), Precise{.estimate_error = true});
  plain.step(20), watched.step(20);
  EXPECT_EQ(plain.hash(), watched.hash());
  EXPECT_FALSE(plain.statistics().error.known);
  const auto snapshot = watched.save();
  watched.step(20);
  const double estimated = watched.statistics().error.position;
  const std::uint64_t hash = watched.hash();
  watched.restore(snapshot);
  watched.step(20);
  EXPECT_EQ(watched.statistics().error.position, estimated);
  EXPECT_EQ(watched.hash(), hash);
  EXPECT_THROW(plain.restore(snapshot), Error);
}

}  // namespace
}  // namespace plumb
