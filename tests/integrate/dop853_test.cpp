#include "engine/integrate/dop853.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "engine/integrate/dop853_coefficients.h"

namespace plumb {
namespace {

using namespace dop853;

long double power(long double x, int n) {
  long double result = 1;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

TEST(Dop853Coefficients, StagesAreConsistent) {
  for (int s = 0; s < kStages; ++s) {
    long double sum = 0;
    for (int j = 0; j < s; ++j) sum += kA[s][j];
    EXPECT_NEAR(static_cast<double>(sum), kC[s], 5e-15) << s;
    for (int j = s; j < kStages; ++j) EXPECT_EQ(kA[s][j], 0) << "explicit";
  }
}

// The conditions for quadrature, and those of two kinds of trees that a wrong weight in the stages breaks:
// sum b_i c_i^k = 1/(k + 1), sum b_i c_i^m a_ij c_j^n = 1/((n + 1)(m + n + 2)) (Hairer, Norsett & Wanner,
// II.2).
TEST(Dop853Coefficients, MeetOrderConditions) {
  for (int k = 0; k <= 7; ++k) {
    long double sum = 0;
    for (int i = 0; i < kStages; ++i) sum += kB[i] * power(kC[i], k);
    EXPECT_NEAR(static_cast<double>(sum), 1.0 / (k + 1), 2e-15) << k;
  }
  for (int m = 0; m <= 5; ++m) {
    for (int n = 1; m + n <= 6; ++n) {
      long double sum = 0;
      for (int i = 0; i < kStages; ++i) {
        for (int j = 0; j < i; ++j) sum += kB[i] * power(kC[i], m) * kA[i][j] * power(kC[j], n);
      }
      EXPECT_NEAR(static_cast<double>(sum), 1.0 / ((n + 1) * (m + n + 2)), 1e-14) << m << " " << n;
    }
  }
}

TEST(Dop853Coefficients, MeetOrderConditionsOfTallTrees) {
  // sum b_i (A^p c)_i = 1/(p + 2)!: linear equations, up to order 8.
  std::vector<long double> v(kC, kC + kStages);
  double factorial = 2;
  for (int p = 0; p <= 6; ++p) {
    long double sum = 0;
    for (int i = 0; i < kStages; ++i) sum += kB[i] * v[i];
    EXPECT_NEAR(static_cast<double>(sum) * factorial, 1, 1e-11) << p;
    std::vector<long double> next(kStages);
    for (int i = 0; i < kStages; ++i) {
      for (int j = 0; j < i; ++j) next[i] += kA[i][j] * v[j];
    }
    v = next;
    factorial *= p + 3;
  }
}

TEST(Dop853Coefficients, ErrorEstimatesVanishForLowOrders) {
  for (int k = 0; k <= 4; ++k) {
    long double sum = 0;
    for (int i = 0; i < kStages; ++i) sum += kError5[i] * power(kC[i], k);
    EXPECT_NEAR(static_cast<double>(sum), 0, 2e-15) << k;
  }
  for (int k = 0; k <= 2; ++k) {
    const double sum = kOrder3[0] * (k == 0 ? 1 : 0) + kOrder3[1] * std::pow(kC[8], k) + kOrder3[2];
    EXPECT_NEAR(sum, 1.0 / (k + 1), 1e-15) << k;
  }
}

struct Equation final : Flow {
  std::function<void(double, std::span<const double>, std::span<double>)> f;
  void rate(double t, std::span<const double> y, std::span<double> out) override { f(t, y, out); }
};

/// y' = y^2, y(0) = 1: y = 1 / (1 - t). Global error at t = 1/2 with `steps` equal steps.
double error_with(int steps) {
  Equation equation;
  equation.f = [](double, std::span<const double> y, std::span<double> out) { out[0] = y[0] * y[0]; };
  Dop853 method(1);
  std::vector<double> y{1};
  const double h = 0.5 / steps;
  for (int i = 0; i < steps; ++i) {
    equation.rate(i * h, y, method.first_rate());
    method.step(equation, i * h, h, y);
    y[0] += method.increment()[0];
  }
  return std::abs(y[0] - 2);
}

TEST(Dop853, IsOfOrderEight) {
  const double order = std::log2(error_with(2) / error_with(4));
  EXPECT_GT(order, 7.5);
  EXPECT_LT(order, 10);
}

TEST(Dop853, EstimateIsAboveTheErrorAndOfItsSize) {
  Equation equation;
  equation.f = [](double, std::span<const double> y, std::span<double> out) { out[0] = y[0] * y[0]; };
  Dop853 method(1);
  const std::vector<double> y{1}, scale{1};
  equation.rate(0, y, method.first_rate());
  for (const double h : {0.05, 0.1, 0.2}) {
    method.step(equation, 0, h, y);
    const double error = std::abs(1 + method.increment()[0] - 1 / (1 - h));
    EXPECT_GE(method.error(h, scale), error) << h;
    EXPECT_LT(method.error(h, scale), 1e-6) << h;
  }
}

TEST(Dop853, SevenfoldPolynomialsAreExact) {
  Equation equation;
  equation.f = [](double t, std::span<const double>, std::span<double> out) {
    out[0] = 8 * t * t * t * t * t * t * t;
  };
  Dop853 method(1);
  const std::vector<double> y{0};
  equation.rate(0, y, method.first_rate());
  method.step(equation, 0, 2, y);
  EXPECT_NEAR(method.increment()[0], 256, 1e-12);
}

TEST(Dop853, ErrorOfAStateThatIsNotFiniteIsInfinite) {
  Equation equation;
  equation.f = [](double t, std::span<const double>, std::span<double> out) { out[0] = t > 0 ? NAN : 0; };
  Dop853 method(1);
  const std::vector<double> y{0}, scale{1};
  equation.rate(0, y, method.first_rate());
  method.step(equation, 0, 1, y);
  EXPECT_TRUE(std::isinf(method.error(1, scale)));
}

TEST(Dop853Coefficients, StagesOfThePolynomialAreConsistent) {
  for (int s = 0; s < kDenseStages; ++s) {
    for (int power_of_c = 0; power_of_c <= 5; ++power_of_c) {  // sum a_sj c_j^k = c_s^(k + 1) / (k + 1)
      long double sum = 0;
      for (int j = 0; j < kStages; ++j) sum += kDenseA[s][j] * power(kC[j], power_of_c);
      sum += kDenseA[s][kStages];  // at c = 1
      for (int j = 0; j < s; ++j) sum += kDenseA[s][kStages + 1 + j] * power(kDenseC[j], power_of_c);
      EXPECT_NEAR(static_cast<double>(sum),
                  static_cast<double>(power(kDenseC[s], power_of_c + 1)) / (power_of_c + 1), 1e-14)
          << s << " " << power_of_c;
    }
  }
}

/// y' = y^2 from y(0) = 1 by one step: the polynomial's largest error between its ends.
double error_within(double h) {
  Equation equation;
  equation.f = [](double, std::span<const double> y, std::span<double> out) { out[0] = y[0] * y[0]; };
  Dop853 method(1);
  StepPolynomial path(1);
  const std::vector<double> y{1};
  equation.rate(0, y, method.first_rate());
  method.step(equation, 0, h, y);
  const std::vector<double> end{1 + method.increment()[0]};
  equation.rate(h, end, method.last_rate());
  method.polynomial(equation, 0, h, y, path);
  double worst = 0;
  for (int i = 1; i < 16; ++i) {
    const double s = i / 16.0;
    worst = std::max(worst, std::abs(1 + path.at(s, 0) - 1 / (1 - s * h)));
  }
  return worst;
}

TEST(Dop853, PolynomialIsOfOrderSeven) {
  const double order = std::log2(error_within(0.2) / error_within(0.1)) - 1;  // of a step's error, h^8
  EXPECT_GT(order, 6.8);
  EXPECT_LT(order, 8.5);
}

TEST(Dop853, PolynomialReproducesOnesOfDegreeSeven) {
  Equation equation;
  equation.f = [](double t, std::span<const double>, std::span<double> out) {
    out[0] = 7 * t * t * t * t * t * t;
  };
  Dop853 method(1);
  StepPolynomial path(1);
  const std::vector<double> y{3};
  equation.rate(0, y, method.first_rate());
  method.step(equation, 0, 2, y);
  equation.rate(2, y, method.last_rate());
  method.polynomial(equation, 0, 2, y, path);
  const auto bernstein = path.bernstein(0);
  for (int i = 0; i <= 8; ++i) {
    const double s = i / 8.0, t = 2 * s;
    EXPECT_NEAR(path.at(s, 0), static_cast<double>(power(t, 7)), 2e-12) << s;
    EXPECT_NEAR(path.slope(s, 0), static_cast<double>(2 * 7 * power(t, 6)), 2e-11) << s;
    double blended = 0;  // sum C(7, j) s^j (1 - s)^(7 - j) b_j
    constexpr double kChoose7[8] = {1, 7, 21, 35, 35, 21, 7, 1};
    for (int j = 0; j < 8; ++j) {
      blended += kChoose7[j] * static_cast<double>(power(s, j) * power(1 - s, 7 - j)) * bernstein[j];
    }
    EXPECT_NEAR(blended, path.at(s, 0), 2e-12) << s;
  }
}

}  // namespace
}  // namespace plumb
