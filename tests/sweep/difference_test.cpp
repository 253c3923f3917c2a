#include "harness/sweep/difference.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "harness/sweep/rank_test.h"
#include "harness/sweep/rows.h"
#include "tests/sweep/rows.h"

namespace plumb::harness::sweep {
namespace {

// All divisions of the common order, one by one.
double by_brute_force(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  std::vector<double> ranks;
  for (const double x : all) {
    double below = 0, equal = 0;
    for (const double y : all) {
      below += y < x ? 1 : 0;
      equal += y == x ? 1 : 0;
    }
    ranks.push_back(below + (equal + 1) / 2);
  }
  const auto n = all.size();
  double middle = 0, seen = 0;
  for (std::size_t i = 0; i < n; ++i) {
    middle += ranks[i] * static_cast<double>(a.size()) / static_cast<double>(n);
    if (i < a.size()) seen += ranks[i];
  }
  double far = 0, ways = 0;
  for (unsigned mask = 0; mask < (1U << n); ++mask) {
    if (static_cast<std::size_t>(__builtin_popcount(mask)) != a.size()) continue;
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += (mask >> i & 1U) != 0 ? ranks[i] : 0;
    ways += 1;
    far += std::abs(sum - middle) >= std::abs(seen - middle) - 1e-9 ? 1 : 0;
  }
  return far / ways;
}

TEST(RankTest, IsExact) {
  const std::vector<double> low{1, 2, 3, 4, 5, 6, 7, 8, 9}, high{11, 12, 13, 14, 15, 16, 17, 18, 19};
  EXPECT_NEAR(rank_test(low, high), 2.0 / 48620, 1e-15) << "two of 18 over 9 divisions";
  EXPECT_NEAR(rank_test(low, low), 1, 1e-12);
  EXPECT_EQ(rank_test({}, low), 1);
  const std::vector<std::pair<std::vector<double>, std::vector<double>>> samples{
      {{1, 4, 2}, {3, 5, 6, 7}},
      {{1, 1, 2, 3}, {2, 2, 5}},  // ties
      {{5, 5, 5}, {5, 5}},
      {{0.3, 7, 2, 9, 4, 4}, {1, 8, 8, 3, 12, 4}}};
  for (const auto& [a, b] : samples) {
    EXPECT_NEAR(rank_test(a, b), by_brute_force(a, b), 1e-12);
    EXPECT_NEAR(rank_test(a, b), rank_test(b, a), 1e-12);
  }
}

Result timed(double dt, double factor, int repetitions = 9) {
  Result out = row("plumb", 1e-3, 1000, dt);
  out.cost->each_ns_per_step.clear();
  for (int i = 0; i < repetitions; ++i) out.cost->each_ns_per_step.push_back(factor * (100 + i));
  out.cost->ns_per_step = factor * (100 + repetitions / 2.0);
  return out;
}

TEST(Difference, CostsAreBetterWorseOrNotToBeTold) {
  const std::vector<Result> before{timed(0.1, 1), timed(0.2, 1), timed(0.3, 1), timed(0.4, 1, 5)};
  const std::vector<Result> after{timed(0.1, 0.5), timed(0.2, 2), timed(0.3, 1.01), timed(0.4, 0.5, 5)};
  const std::vector<Difference> rows = differences(before, after);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].cost, Verdict::Better);
  EXPECT_EQ(rows[1].cost, Verdict::Worse);
  EXPECT_EQ(rows[2].cost, Verdict::CannotTell);
  EXPECT_EQ(rows[3].cost, Verdict::TooFew);
  EXPECT_TRUE(any_worse(rows));
  EXPECT_FALSE(any_worse(std::span(rows).subspan(2)));
  const std::string text = difference_table(rows, {});
  for (const char* part :
       {"1 better, 1 worse, 1 cannot be told", "1 have fewer than 9", "errors of 4 identical"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_LT(text.find("worse"), text.find("better")) << "what is worse comes first";
}

// A difference at the edge of what one test would call real is not called so among a hundred.
TEST(Difference, ManyTestsAreOneComparison) {
  std::vector<Result> before, after;
  for (int i = 1; i <= 100; ++i) {
    before.push_back(timed(0.001 * i, 1));
    after.push_back(timed(0.001 * i, 1.04));  // p is 0.02 or so
  }
  const std::vector<Difference> all = differences(before, after);
  EXPECT_LT(all[0].chance, kChance);
  for (const Difference& one : all) EXPECT_EQ(one.cost, Verdict::CannotTell);
  const std::vector<Difference> alone = differences(std::span(before).first(1), std::span(after).first(1));
  EXPECT_EQ(alone[0].cost, Verdict::Worse);
}

TEST(Difference, ErrorsAreHeldBitByBit) {
  std::vector<Result> before{row("a", 1e-3, 1), row("b", 1e-3, 1), row("c", 1e-3, 1), row("gone", 1, 1)};
  std::vector<Result> after{row("a", 1e-3, 1), row("b", std::nextafter(1e-3, 1), 1), row("c", 0.9e-3, 1),
                            row("new", 1, 1)};
  after[2].status = Status::Crashed;
  const std::vector<Difference> rows = differences(before, after);
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_TRUE(rows[0].errors.empty());
  ASSERT_EQ(rows[1].errors.size(), 1u);
  EXPECT_FALSE(rows[1].errors[0].better());
  EXPECT_TRUE(rows[2].errors[0].better());
  EXPECT_TRUE(any_worse(std::span(rows).subspan(2, 1))) << "it does not run any more";
  EXPECT_FALSE(rows[3].after);
  EXPECT_FALSE(rows[4].before);
}

TEST(Difference, CostsOfDifferentMachinesAreNotCompared) {
  std::vector<Result> before{timed(0.1, 1), timed(0.2, 1), timed(0.3, 1)}, after = before;
  for (Result& result : after) {
    result.cost->each_ns_per_step = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    result.cost->ns_per_step = 5;
  }
  before[0].machine = before[1].machine = after[1].machine = after[2].machine = "a processor";
  after[0].machine = "another";
  const std::vector<Difference> rows = differences(before, after);
  EXPECT_EQ(rows[0].cost, Verdict::Elsewhere);
  EXPECT_EQ(rows[1].cost, Verdict::Better);
  EXPECT_EQ(rows[2].cost, Verdict::Better) << "where one is unknown they are taken as they are";
  EXPECT_NE(difference_table(rows, {}).find("1 left out: measured on different kinds of machine"),
            std::string::npos);
}

TEST(Rows, ASceneKeepsTheCostsOfTheKindOfMachineThatHasMost) {
  std::vector<Result> rows;
  for (const char* machine : {"old", "new", "new", "", "old"}) {
    rows.push_back(row("plumb", 1e-3, 100));
    rows.back().machine = machine;
  }
  rows.back().label = "another scene";
  std::vector<Result> chosen = rows;
  keep_costs_of_one_machine(chosen, "old");
  EXPECT_TRUE(chosen[0].cost && !chosen[1].cost && !chosen[2].cost && chosen[3].cost && chosen[4].cost);
  EXPECT_THROW(keep_costs_of_one_machine(chosen, "older"), Error);
  keep_costs_of_one_machine(rows);
  EXPECT_FALSE(rows[0].cost);
  EXPECT_TRUE(rows[0].cost_left_out);
  EXPECT_TRUE(rows[0].metrics.position_error) << "errors are the same everywhere";
  for (const std::size_t kept : {1, 2, 3, 4}) {
    EXPECT_TRUE(rows[kept].cost) << kept;
    EXPECT_FALSE(rows[kept].cost_left_out) << kept;
  }
}

}  // namespace
}  // namespace plumb::harness::sweep
