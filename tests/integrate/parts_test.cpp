#include <gtest/gtest.h>

#include <cmath>

#include "engine/integrate/bernstein.h"
#include "engine/integrate/compensated.h"
#include "engine/integrate/step_control.h"
#include "engine/integrate/step_polynomial.h"

namespace plumb {
namespace {

TEST(Compensated, SmallIncrementsAreNotLost) {
  Compensated sum(1);
  sum.set(0, 1);
  for (int i = 0; i < 100000; ++i) sum.add(0, 1e-17);
  EXPECT_NEAR(sum[0], 1 + 1e-12, 2.3e-16);
  double plain = 1;
  for (int i = 0; i < 100000; ++i) plain += 1e-17;
  EXPECT_EQ(plain, 1);
}

TEST(StepControl, GrowsWhenTheErrorIsSmallAndShrinksWhenLarge) {
  StepControl control;
  EXPECT_GT(control.after_acceptance(1e-6), 2);
  StepControl tight;
  EXPECT_LT(tight.after_acceptance(0.99), 1);
  EXPECT_DOUBLE_EQ(control.after_rejection(INFINITY), 0.2);
  EXPECT_DOUBLE_EQ(control.after_rejection(NAN), 0.2);
  EXPECT_NEAR(control.after_rejection(16), 0.9 * std::pow(16, -1.0 / 8), 1e-14);
  EXPECT_NEAR(StepControl(StepControl::kCareful).after_rejection(16), 0.8 * std::pow(16, -1.0 / 8), 1e-14);
}

TEST(StepControl, SettlesWhereTheErrorIsJustBelowOne) {
  // error = (h / h1)^8: the controller must find a step with an error below 1 and stay there.
  StepControl control;
  double h = 0.01;
  for (int i = 0; i < 60; ++i) {
    const double error = std::pow(h, 8);
    h *= error <= 1 ? control.after_acceptance(error) : control.after_rejection(error);
  }
  EXPECT_LT(h, 1);
  EXPECT_GT(h, 0.7);
}

/// (s - a)(s - b) scaled by `k`, by its Bernstein coefficients.
Bernstein<3> with_roots(double a, double b, double k) {
  return {k * a * b, k * (a * b - (a + b) / 2), k * (1 - a) * (1 - b)};
}

TEST(Bernstein, FindsTheDescentOnly) {
  EXPECT_NEAR(*first_down_crossing(with_roots(0.3, 0.8, 1)), 0.3, 1e-15);
  EXPECT_NEAR(*first_down_crossing(with_roots(0.3, 0.8, -1)), 0.8, 1e-15);
  EXPECT_NEAR(*first_down_crossing(with_roots(0.3, 1.8, 1)), 0.3, 1e-15);
  EXPECT_FALSE(first_down_crossing(with_roots(1.3, 1.8, 1)));
  EXPECT_FALSE(first_down_crossing(with_roots(-0.5, 0.5, 1)));  // comes from below
  Bernstein<3> near_miss = with_roots(0.5, 0.5, 1);
  for (double& c : near_miss) c += 1e-12;
  EXPECT_FALSE(first_down_crossing(near_miss));
}

TEST(Bernstein, FindsRootsThatAreCloseTogether) {
  EXPECT_NEAR(*first_down_crossing(with_roots(0.4, 0.4 + 1e-6, 1)), 0.4, 1e-9);
  EXPECT_NEAR(*first_down_crossing(with_roots(0.999999, 2, 1)), 0.999999, 1e-15);
}

TEST(Bernstein, HalvesMeetInTheMiddle) {
  Bernstein<3> left{}, right{};
  halve(with_roots(0.25, 0.75, 1), left, right);
  EXPECT_DOUBLE_EQ(left[2], -0.0625);
  EXPECT_DOUBLE_EQ(right[0], -0.0625);
  EXPECT_DOUBLE_EQ(left[0], 0.1875);
}

TEST(StepPolynomial, OfLowDegreeIsWrittenWithMoreCoefficients) {
  // 2 s - 3 s (s - 1/2) = 3.5 s - 3 s^2, whose Bernstein coefficients of degree 7 are 3.5 j/7 - 3 j (j -
  // 1)/42.
  StepPolynomial path(1);
  path.set_nodes(std::array{0.0, 0.5});
  path.term(1)[0] = 2;
  path.term(2)[0] = -3;
  EXPECT_DOUBLE_EQ(path.at(0.25, 0), 3.5 * 0.25 - 3 * 0.0625);
  EXPECT_DOUBLE_EQ(path.slope(0.25, 0), 3.5 - 6 * 0.25);
  const auto c = path.bernstein(0);
  for (int j = 0; j < 8; ++j) EXPECT_NEAR(c[j], 0.5 * j - j * (j - 1) / 14.0, 1e-15) << j;
}

}  // namespace
}  // namespace plumb
