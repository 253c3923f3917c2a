#include "harness/thresholds/bisection.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

// The search itself, on judges whose answer is known.
namespace plumb::harness::thresholds {
namespace {

constexpr SearchRange kLinear{.low = 0.2, .high = 1.4};
constexpr SearchRange kLogarithmic{.low = 1, .high = 1e8, .logarithmic = true};

auto below(double critical) {
  return [critical](double value) { return Answer{value < critical, value < critical ? "" : "it fell"}; };
}
auto above(double critical) {
  return [critical](double value) { return Answer{value > critical, value > critical ? "" : "it fell"}; };
}

void expect_bracket(const Crossing& crossing, double critical, double resolution) {
  EXPECT_EQ(crossing.ending, Ending::Found) << crossing.reason;
  EXPECT_LE(crossing.low, critical);
  EXPECT_GE(crossing.high, critical);
  EXPECT_LE(crossing.high - crossing.low, resolution * crossing.value);
  EXPECT_NEAR(crossing.value, critical, resolution / 2 * critical);
  EXPECT_EQ(crossing.reason, "it fell");
}

TEST(Bisection, FindsWhatHoldsBelow) {
  for (const double critical : {0.2001, 0.36397, 0.8, 1.2, 1.3999})
    expect_bracket(find_crossing(kLinear, below(critical)), critical, 1e-3);
}

TEST(Bisection, FindsWhatHoldsAbove) {
  SearchRange range = kLinear;
  range.holds_below = false;
  for (const double critical : {0.2001, 0.36397, 0.8, 1.2, 1.3999})
    expect_bracket(find_crossing(range, above(critical)), critical, 1e-3);
}

TEST(Bisection, FindsOnALogarithmicScale) {
  for (const double critical : {1.001, 120.0, 4.7e5, 9.99e7})
    expect_bracket(find_crossing(kLogarithmic, below(critical)), critical, 1e-3);
}

TEST(Bisection, MoreDigitsNarrowTheBracket) {
  SearchRange range = kLinear;
  range.resolution = 1e-6;
  expect_bracket(find_crossing(range, below(0.36397)), 0.36397, 1e-6);
}

TEST(Bisection, SaysWhereItHoldsEverywhereAndNowhere) {
  const Crossing always = find_crossing(kLogarithmic, below(1e9));
  EXPECT_EQ(always.ending, Ending::Always);
  EXPECT_TRUE(std::isnan(always.value));
  EXPECT_EQ(always.high, 1e8);
  EXPECT_EQ(always.runs, 7);
  const Crossing never = find_crossing(kLinear, below(0));
  EXPECT_EQ(never.ending, Ending::Never);
  EXPECT_EQ(never.reason, "it fell");
  EXPECT_EQ(never.low, 0.2);
}

// A window that the scan over the range sees.
TEST(Bisection, AnswersThatChangeFarApartAreNotClear) {
  const Crossing crossing = find_crossing(kLinear, [](double value) {
    return Answer{value < 0.5 || value > 0.9, "it fell"};
  });
  EXPECT_EQ(crossing.ending, Ending::Unclear);
  EXPECT_NEAR(crossing.value, 0.5, 1e-3);
  EXPECT_GE(crossing.low, 0.5);
  EXPECT_EQ(crossing.high, 1.4);
  EXPECT_NE(crossing.reason.find("holds at 1.4"), std::string::npos) << crossing.reason;
}

// A window that only what is looked at beside the bracket sees.
TEST(Bisection, AnswersThatChangeNearByAreNotClear) {
  const auto window = [](double value) {
    return Answer{value < 0.5 || std::abs(value - 0.515) < 1e-3, "it fell"};
  };
  EXPECT_EQ(find_crossing(kLinear, window).ending, Ending::Unclear);
}

TEST(Bisection, BreakingWhereItShouldHoldIsNotClear) {
  const Crossing crossing = find_crossing(kLinear, above(0.7));
  EXPECT_EQ(crossing.ending, Ending::Unclear);
  EXPECT_TRUE(std::isnan(crossing.value));
}

// A judge that rolls dice, and one that a range cannot narrow: it ends.
TEST(Bisection, Ends) {
  unsigned state = 1;
  const auto dice = [&](double) {
    state = state * 1664525u + 1013904223u;
    return Answer{(state >> 16) % 2 == 0, "chance"};
  };
  for (int i = 0; i < 200; ++i) EXPECT_LE(find_crossing(kLinear, dice).runs, kMostRuns);
  SearchRange range = kLinear;
  range.resolution = 0;
  EXPECT_LE(find_crossing(range, below(0.36397)).runs, kMostRuns);
}

TEST(Bisection, PassesOnWhatTheJudgeThrows) {
  EXPECT_THROW(find_crossing(kLinear, [](double) -> Answer { throw std::runtime_error("no"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace plumb::harness::thresholds
