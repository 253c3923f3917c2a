#include "harness/sweep/explorer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "tests/harness/fakes.h"

namespace plumb::harness::sweep {
namespace {

/// An engine whose error and cost are formulas: a first and a second-order method, sweeps that help up to a
/// floor, and a knob without effect.
class Formula final : public reference::Backend {
 public:
  std::string_view name() const override { return "formula"; }
  std::string_view summary() const override { return ""; }
  reference::Identity identity() const override { return {.version = "1", .precision = "double"}; }
  std::vector<reference::Option> options() const override {
    return {{"scheme", "first", ""}, {"sweeps", "4", ""}, {"idle", "b", ""}};
  }
  std::vector<reference::Knob> knobs() const override {
    return {{"scheme", {"first", "second"}, false},
            {"sweeps", {"1", "2", "4", "8", "16"}},
            {"idle", {"a", "b", "c"}}};
  }
  reference::Method method(const reference::StepSettings& settings) const override {
    return {.substep = settings.dt};
  }
  std::string unsupported(const Scene&, const reference::StepSettings&) const override { return ""; }
  reference::Settings effective_settings(const Scene&, const reference::StepSettings&) const override {
    return {};
  }
  std::unique_ptr<reference::Simulator> create(const Scene&, const reference::StepSettings&) const override {
    return nullptr;
  }

  static double error(const reference::StepSettings& s) {
    const double dt = s.dt, sweeps = std::stod(s.options.at("sweeps"));
    const double step = s.options.at("scheme") == "first" ? dt : 2 * dt * dt;
    return step * (1 + 10 * std::exp(-sweeps));
  }
  static double cost(const reference::StepSettings& s) {
    const double scheme = s.options.at("scheme") == "first" ? 1 : 1.5;
    return scheme * (3 + std::stod(s.options.at("sweeps"))) / s.dt;
  }
};

TEST(Space, StartsAtTheDefaultsAndKnowsItsPlaces) {
  const Formula engine;
  const Space space(engine, {});
  const reference::StepSettings start = space.settings(space.start());
  EXPECT_EQ(start.dt, 1.0 / 60);
  EXPECT_EQ(start.options.at("sweeps"), "4");
  EXPECT_EQ(start.options.at("idle"), "b");
  EXPECT_EQ(space.find(start), space.start());
  EXPECT_FALSE(space.find({.dt = 0.017}));
  EXPECT_EQ(space.neighbours(space.start()).size(), 2u + 1 + 2 + 2);
  for (int rung = 0; rung < 11; ++rung) {
    const double dt = Ladder{}.dt(rung), steps = sample_interval(dt) / dt;
    EXPECT_EQ(steps, std::round(steps));
    EXPECT_LE(sample_interval(dt), std::max(dt, 1.0 / 240) * (1 + 1e-12));
  }
}

// Within 60 of the 330 places it has the front that all of them have, to a few percent of cost everywhere.
TEST(Explorer, FindsTheFrontWithFewRuns) {
  const Formula engine;
  Explorer explorer{Space(engine, {})};
  std::set<Space::Place> seen;
  while (seen.size() < 60) {
    const auto place = explorer.next(1e6);
    if (!place) break;
    EXPECT_TRUE(seen.insert(*place).second) << "one place twice";
    const auto settings = explorer.space().settings(*place);
    explorer.tell(*place, Formula::error(settings), Formula::cost(settings));
  }
  int idle = 0;
  for (const Space::Place& place : seen)  // places that differ from another in the idle knob alone
    for (int value = 0; value < place[3]; ++value)
      idle += seen.contains({place[0], place[1], place[2], value}) ? 1 : 0;
  EXPECT_LE(idle, 8)
      << "a knob that does nothing is left alone: two trials at a point say so, a few stand elsewhere";
  const auto front = explorer.front();
  for (double wanted = 0.05; wanted > 1e-6; wanted /= 3) {
    double best = INFINITY, found = INFINITY;
    Space all(engine, {});
    for (int rung = 0; rung < 11; ++rung)
      for (int scheme = 0; scheme < 2; ++scheme)
        for (int sweeps = 0; sweeps < 5; ++sweeps) {
          const auto settings = all.settings({rung, scheme, sweeps, 1});
          if (Formula::error(settings) <= wanted) best = std::min(best, Formula::cost(settings));
        }
    for (const auto& point : front)
      if (point.error <= wanted) found = std::min(found, point.cost);
    if (best < 5e5) {
      EXPECT_LE(found, 1.25 * best) << wanted;
    }
  }
}

TEST(Explorer, WhatFailsIsNotTriedAgain) {
  const Formula engine;
  Explorer explorer{Space(engine, {})};
  std::set<Space::Place> seen;
  while (const auto place = explorer.next(1e9)) {
    EXPECT_TRUE(seen.insert(*place).second);
    explorer.fail(*place);
  }
  EXPECT_GE(seen.size(), 3u) << "finer steps may run where the default does not";
}

TEST(Explorer, GoesTowardsAGoal) {
  const Formula engine;
  for (const double wanted : {0.03, 1e-3, 1e-5}) {
    Explorer explorer{Space(engine, {})};
    int runs = 0;
    while (const auto place = explorer.next_towards({.error = wanted, .cost = {}}, 1e7)) {
      ASSERT_LT(++runs, 60);
      const auto settings = explorer.space().settings(*place);
      explorer.tell(*place, Formula::error(settings), Formula::cost(settings));
    }
    double best = INFINITY, found = INFINITY;
    const Space all(engine, {});
    for (int rung = 0; rung < 11; ++rung)
      for (int scheme = 0; scheme < 2; ++scheme)
        for (int sweeps = 0; sweeps < 5; ++sweeps) {
          const auto settings = all.settings({rung, scheme, sweeps, 1});
          if (Formula::error(settings) <= wanted) best = std::min(best, Formula::cost(settings));
        }
    for (const auto& point : explorer.front())
      if (point.error <= wanted) found = std::min(found, point.cost);
    EXPECT_LE(found, 1.5 * best) << wanted << " in " << runs;
  }
  Explorer explorer{Space(engine, {})};
  while (const auto place = explorer.next_towards({.error = {}, .cost = 2000}, 1e7)) {
    const auto settings = explorer.space().settings(*place);
    explorer.tell(*place, Formula::error(settings), Formula::cost(settings));
  }
  double error = INFINITY;
  for (const auto& point : explorer.front())
    if (point.cost <= 2000) error = std::min(error, point.error);
  EXPECT_LE(error, 1.5 * 2 / (120.0 * 120)) << "the second-order scheme at 1/120 costs 7.5 * 120 at 2 sweeps";
}

}  // namespace
}  // namespace plumb::harness::sweep
