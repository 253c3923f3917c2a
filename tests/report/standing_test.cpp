#include "harness/report/standing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb::harness::report {
namespace {

Result point(const std::string& label, const std::string& engine, double error, double cost,
             double dt = 0.1) {
  Result row;
  row.label = label;
  row.engine = engine;
  row.dt = row.asked.dt = dt;
  row.metrics.position_error = error;
  row.cost = Cost{.ns_per_step = cost * dt,
                  .ns_per_step_low = 0.99 * cost * dt,
                  .ns_per_step_high = 1.01 * cost * dt,
                  .ns_per_simulated_second = cost,
                  .repetitions = 9};
  return row;
}

TEST(Standing, CountsWhatNoSettingOfPlumbReaches) {
  // plumb: 100 ns for 1e-3, 1000 ns for 1e-6. The rival is cheaper at 1e-2, dearer at 1e-5, and more accurate
  // at last.
  const std::vector<Result> rows{point("a", "plumb", 1e-3, 100, 0.1),
                                 point("a", "plumb-precise", 1e-6, 1000, 0.1),
                                 point("a", "rival", 1e-2, 50, 0.1), point("a", "rival", 1e-5, 4000, 0.05),
                                 point("a", "rival", 1e-9, 9000, 0.025)};
  const std::vector<Standing> table = standings(rows);
  ASSERT_EQ(table.size(), 1u);
  EXPECT_EQ(table[0].dominance.rival, "rival");
  EXPECT_EQ(table[0].dominance.points, 3);
  EXPECT_EQ(table[0].worse, 2);
  EXPECT_EQ(table[0].clearly_worse, 2);
  EXPECT_EQ(table[0].unreached, 1);
  // At 1e-2 plumb pays 100 for 50, at 1e-5 1000 for 4000: 2 and 1/4, whose geometric mean is sqrt(1/2).
  EXPECT_DOUBLE_EQ(table[0].cost_ratio.value(), std::sqrt(0.5));
  // For 50 plumb has nothing; for 4000 1e-6 over 1e-5; for 9000 1e-6 over 1e-9.
  EXPECT_DOUBLE_EQ(table[0].error_ratio.value(), 10);
}

TEST(Standing, FirstWherePlumbIsWorse) {
  const std::vector<Result> rows{point("won", "plumb", 1e-3, 100),  point("won", "rival", 1e-2, 200),
                                 point("lost", "plumb", 1e-3, 100), point("lost", "rival", 1e-4, 50),
                                 point("even", "plumb", 1e-3, 100), point("even", "rival", 1e-3, 99.5)};
  const std::vector<Standing> table = standings(rows);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0].dominance.label, "lost");
  EXPECT_EQ(table[1].dominance.label, "even");
  EXPECT_EQ(table[1].worse, 1);
  EXPECT_EQ(table[1].clearly_worse, 0) << "half a percent is within the quartiles";
  EXPECT_EQ(table[2].dominance.label, "won");
  EXPECT_EQ(table[2].worse, 0);
}

TEST(Standing, SaysWhyThereIsNoPoint) {
  Result skipped = point("a", "rival", 1, 1);
  skipped.cost.reset();
  skipped.metrics = {};
  skipped.status = Status::Skipped;
  skipped.reason = "has no springs";
  const std::vector<Standing> table = standings(std::vector{point("a", "plumb", 1e-3, 100), skipped});
  ASSERT_EQ(table.size(), 1u);
  EXPECT_EQ(table[0].dominance.points, 0);
  EXPECT_EQ(table[0].why_none, "skipped: has no springs");
}

}  // namespace
}  // namespace plumb::harness::report
