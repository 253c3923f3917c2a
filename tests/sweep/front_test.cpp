#include "harness/sweep/front.h"

#include <cmath>

#include <gtest/gtest.h>

#include "harness/sweep/front_tables.h"
#include "harness/sweep/trade.h"
#include "tests/sweep/rows.h"

namespace plumb::harness::sweep {
namespace {

const MetricField& position() { return kMetricFields[0]; }

TEST(Front, IsWhatNothingElseBeats) {
  const std::vector<Result> rows{row("a", 1, 100), row("a", 0.1, 400),
                                 row("a", 0.5, 500),  // beaten by the second
                                 row("a", 1, 120),    // by the first
                                 row("a", 0.01, 1600)};
  const std::vector<Point> front = front_of(points_of(rows, position()));
  ASSERT_EQ(front.size(), 3u);
  EXPECT_EQ(front[0].cost, 100);
  EXPECT_EQ(front[1].cost, 400);
  EXPECT_EQ(front[2].cost, 1600);
}

TEST(Front, LeavesOutWhatDidNotRunOrWasNotMeasured) {
  std::vector<Result> rows{row("a", 1, 100), row("a", 0.1, 200), row("a", 0.1, 300), row("a", NAN, 1)};
  rows[1].status = Status::Diverged;
  rows[2].cost.reset();
  EXPECT_EQ(points_of(rows, position()).size(), 1u);
}

// Errors 1, 0.1, 0.01 at costs 100, 400, 1600: between two, cost goes with the power log 4 / log 10 of
// 1/error.
TEST(Front, InterpolatesInLogLogAndNeverBeyond) {
  const std::vector<Result> rows{row("a", 1, 100), row("a", 0.1, 400), row("a", 0.01, 1600)};
  const std::vector<Point> front = front_of(points_of(rows, position()));
  EXPECT_NEAR(*cost_at_error(front, std::sqrt(0.1)), 200, 1e-10);
  EXPECT_NEAR(*cost_at_error(front, 0.1), 400, 1e-10);
  EXPECT_NEAR(*error_at_cost(front, 800), 0.1 * std::sqrt(0.1), 1e-15);
  EXPECT_NEAR(*error_at_cost(front, 1e9), 0.01, 1e-15) << "more cost buys nothing that was not measured";
  EXPECT_EQ(*cost_at_error(front, 50), 100) << "no cheaper point was measured";
  EXPECT_FALSE(cost_at_error(front, 0.009));
  EXPECT_FALSE(error_at_cost(front, 99));
  EXPECT_FALSE(cost_at_error({}, 1));
  EXPECT_FALSE(error_at_cost({}, 1));
}

TEST(Front, RoundingIsNoAccuracy) {
  const std::vector<Result> rows{row("a", 0, 100), row("a", 1e-15, 90)};
  const std::vector<Point> front = front_of(points_of(rows, position()));
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].cost, 90);
  EXPECT_EQ(front[0].error, kErrorFloor);
}

TEST(Order, IsTheMedianSlopeAboveThePlateau) {
  std::vector<Result> rows;
  for (int i = 0; i < 6; ++i) {
    const double dt = std::ldexp(1.0 / 16, -i);
    rows.push_back(row("a", 3 * dt * dt, 1 / dt, dt));
  }
  const auto order = observed_order(points_of(rows, position()));
  ASSERT_TRUE(order);
  EXPECT_NEAR(order->order, 2, 1e-12);
  EXPECT_EQ(order->pairs, 5);
  // Rounding: from here on the step does nothing.
  for (int i = 6; i < 9; ++i) rows.push_back(row("a", 2e-6, 1, std::ldexp(1.0 / 16, -i)));
  EXPECT_NEAR(observed_order(points_of(rows, position()))->order, 2, 0.2);
  // Rounding that grows with the number of steps is no order.
  const std::vector<Result> rising{row("a", 1e-6, 1, 1.0 / 16), row("a", 1e-5, 1, 1.0 / 32),
                                   row("a", 1e-4, 1, 1.0 / 64)};
  EXPECT_FALSE(observed_order(points_of(rising, position())));
}

TEST(Headline, IsTheMetricThatTheSceneHas) {
  std::vector<Result> rows{row("a", 0, 1), row("b", 1e-14, 1)};
  EXPECT_EQ(headline_metric(rows).name, "position_error");
  rows[1].metrics.angle_error = 1e-3;
  EXPECT_EQ(headline_metric(rows).name, "angle_error") << "pure spin: positions are right to rounding";
  rows[0].metrics.position_error = 1e-3;
  EXPECT_EQ(headline_metric(rows).name, "position_error");
  for (Result& r : rows) {
    r.metrics = {};
    r.metrics.energy_drift = 1;
  }
  EXPECT_EQ(headline_metric(rows).name, "energy_drift");
}

// Of the rival's five points plumb beats three: one strictly, one that is equal in both, one by another
// engine of plumb's; one is more accurate than all of plumb's, and one is cheaper than all.
std::vector<Result> rivalry() {
  return {row("plumb", 0.1, 100),
          row("plumb-float", 1, 40),
          row("rival", 0.2, 150),
          row("rival", 0.1, 100),
          row("rival", 1.5, 50),
          row("rival", 0.01, 1000),
          row("rival", 2, 10),
          row("other", 5, 5, 1.0 / 64),
          row("plumb", 1, 1, 1.0 / 64, "second"),
          row("rival", 1, 2, 1.0 / 64, "second")};
}

TEST(Dominance, CountsWhatSomePointOfPlumbBeats) {
  const std::vector<Result> rows = rivalry();
  const std::vector<Dominance> table = dominance(rows);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0].rival, "rival");
  EXPECT_EQ(table[0].points, 5);
  EXPECT_EQ(table[0].dominated, 3);
  EXPECT_EQ(table[0].front, 4) << "the first is beaten by the second";
  EXPECT_EQ(table[0].front_dominated, 2);
  ASSERT_EQ(table[0].exceptions.size(), 2u);
  EXPECT_EQ(table[0].exceptions[0].error, 0.01);
  EXPECT_EQ(table[0].exceptions[0].cost_ratio, 0) << "never reached";
  EXPECT_NEAR(table[0].exceptions[0].error_ratio, 10, 1e-12);
  EXPECT_EQ(table[0].exceptions[1].error, 2);
  EXPECT_EQ(table[0].exceptions[1].cost_ratio, 4);
  EXPECT_EQ(table[0].exceptions[1].error_ratio, 0) << "nothing is as cheap";
  EXPECT_EQ(table[1].rival, "other");
  EXPECT_EQ(table[1].dominated, 0);
  EXPECT_EQ(table[2].label, "second");
  EXPECT_EQ(table[2].dominated, 1);
  EXPECT_DOUBLE_EQ(overall_share(table), 4.0 / 7);
}

TEST(Dominance, SaysWhereNoiseDecides) {
  std::vector<Result> rows{row("plumb", 1, 101), row("rival", 1, 100)};
  EXPECT_FALSE(dominance(rows)[0].exceptions[0].noise);
  rows[0].cost->ns_per_step_low = 0.9 * rows[0].cost->ns_per_step;
  EXPECT_TRUE(dominance(rows)[0].exceptions[0].noise);
}

TEST(Dominance, RunsThatFailHaveNoPointAndAreCounted) {
  std::vector<Result> rows{row("plumb", 1, 1), row("rival", 1, 2), row("rival", 1, 2, 1.0 / 32)};
  rows[2].status = Status::Crashed;
  EXPECT_EQ(dominance(rows)[0].points, 1);
  EXPECT_EQ(dominance(rows)[0].failed, 1);
}

TEST(Tables, NameScenesEnginesSettingsAndExceptions) {
  const std::vector<Result> rows = rivalry();
  const Style style{.width = 110, .colour = false};
  const std::string text = dominance_table(dominance(rows), style);
  for (const char* part :
       {"scene", "rival", "other", "3/5", "overall", "4/7", "57 %", "not dominated", "dt 1/64"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  const std::string fronts = front_table(std::span(rows).first(8), nullptr, style);
  for (const char* part : {"plumb-float", "position_error", "cost at an error of", "error at a cost of"})
    EXPECT_NE(fronts.find(part), std::string::npos) << part << "\n" << fronts;
  EXPECT_NE(trade_data(rows, nullptr, "json").find("\"dominated_share\": 0.571"), std::string::npos);
  EXPECT_EQ(trade_data(rows, nullptr, "csv").substr(0, 6), "label,");
}

// Two engines, each against its own limit: their errors are distances from different things.
std::vector<Result> rows_of_own_limits() {
  std::vector<Result> rows;
  for (const char* engine : {"plumb", "box2d"}) {
    for (const double dt : {1.0 / 64, 1.0 / 128}) {
      rows.push_back(row(engine, engine[0] == 'p' ? dt : 10 * dt, 1 / dt, dt));
      rows.back().truth = std::string(engine) + "'s own limit";
      rows.back().truth_within.position_error = 1e-3;
      rows.back().truth_asked = reference::StepSettings{.dt = 1.0 / 1024};
      rows.back().metrics.energy_drift = dt;
    }
  }
  return rows;
}

TEST(Dominance, OnlyErrorsAgainstTheSameTruthAreCompared) {
  const std::vector<Result> rows = rows_of_own_limits();
  const std::vector<Dominance> own = dominance(rows);
  ASSERT_EQ(own.size(), 1u);
  EXPECT_FALSE(own[0].compared);
  EXPECT_EQ(own[0].dominated, 0);
  EXPECT_TRUE(own[0].exceptions.empty());
  EXPECT_TRUE(std::isnan(overall_share(own)));
  EXPECT_NE(dominance_table(own, {}).find("not compared"), std::string::npos);
  // Drifts are distances from laws, which all engines share.
  const MetricField& drift = *std::ranges::find(kMetricFields, "energy_drift", &MetricField::name);
  ASSERT_EQ(dominance(rows, &drift).size(), 1u);
  EXPECT_TRUE(dominance(rows, &drift)[0].compared);
}

TEST(FrontTable, NamesTheTruthOfEachEngine) {
  const std::vector<Result> rows = rows_of_own_limits();
  const std::string text = front_table(rows, nullptr, {});
  for (const char* part :
       {"each engine's own limit", "against plumb's own limit", "against box2d's own limit"})
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
  const std::string json = trade_data(rows, nullptr, "json"), csv = trade_data(rows, nullptr, "csv");
  EXPECT_NE(json.find("\"truth\": \"box2d's own limit\""), std::string::npos) << json;
  EXPECT_NE(json.find("\"truth_within\": 0.001"), std::string::npos) << json;
  EXPECT_NE(csv.find(",plumb's own limit,0.001\n"), std::string::npos) << csv;
}

TEST(Rows, KeepTheAccuracyOfTheirTruth) {
  const Result before = rows_of_own_limits().front();
  const Result after = result_from_json(to_json(before));
  EXPECT_EQ(after.truth_within.position_error, 1e-3);
  EXPECT_FALSE(after.truth_within.angle_error);
  ASSERT_TRUE(after.truth_asked);
  EXPECT_EQ(after.truth_asked->dt, 1.0 / 1024);
}

}  // namespace
}  // namespace plumb::harness::sweep
