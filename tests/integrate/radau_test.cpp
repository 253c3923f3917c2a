#include "engine/integrate/radau.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "engine/integrate/radau_coefficients.h"
#include "engine/integrate/step_control.h"

namespace plumb {
namespace {

using namespace radau;

long double power(long double x, int n) {
  long double result = 1;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

TEST(RadauCoefficients, AreThoseOfCollocation) {
  for (int k = 1; k <= kStages; ++k) {  // C(5): sum_j a_ij c_j^(k-1) = c_i^k / k
    for (int i = 0; i < kStages; ++i) {
      long double sum = 0;
      for (int j = 0; j < kStages; ++j) sum += kA[i][j] * power(kC[j], k - 1);
      EXPECT_NEAR(static_cast<double>(sum), static_cast<double>(power(kC[i], k) / k), 2e-16) << k << " " << i;
    }
  }
  for (int k = 1; k <= 2 * kStages - 1; ++k) {  // B(9): sum_i b_i c_i^(k-1) = 1/k
    long double sum = 0;
    for (int i = 0; i < kStages; ++i) sum += kA[kStages - 1][i] * power(kC[i], k - 1);
    EXPECT_NEAR(static_cast<double>(sum), 1.0 / k, 3e-16) << k;
  }
  for (int k = 1; k <= kStages; ++k) {
    long double sum = k == 1 ? kGamma : 0;
    for (int i = 0; i < kStages; ++i) sum += kEstimateB[i] * power(kC[i], k - 1);
    EXPECT_NEAR(static_cast<double>(sum), 1.0 / k, 2e-16) << k;
  }
}

/// Solves A x = b by Gauss's elimination; rows of A one after another.
std::vector<double> solved(std::vector<double> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t p = k;
    for (std::size_t i = k; i < n; ++i) p = std::abs(a[i * n + k]) > std::abs(a[p * n + k]) ? i : p;
    for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[p * n + j]);
    std::swap(b[k], b[p]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i * n + k] / a[k * n + k];
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k * n + j] * b[j];
    b[k] /= a[k * n + k];
  }
  return b;
}

/// An equation with its Jacobian, both as functions; linear systems are dense.
class Stiff final : public StiffFlow {
 public:
  using Rate = std::function<void(std::span<const double>, std::span<double>)>;
  using Jacobian = std::function<void(std::span<const double>, std::span<double>)>;
  Stiff(std::size_t n, Rate f, Jacobian df) : n_(n), f_(std::move(f)), df_(std::move(df)), jacobian_(n * n) {}

  void rate(double, std::span<const double> y, std::span<double> out) override { ++evaluations, f_(y, out); }
  void linearise(double, std::span<const double> y) override { df_(y, jacobian_); }
  bool factor(Use use, std::span<const double> a, int stages, double h) override {
    std::vector<double>& m = matrix_[static_cast<int>(use)];
    const std::size_t size = stages * n_;
    m.assign(size * size, 0);
    for (int s = 0; s < stages; ++s) {
      for (int t = 0; t < stages; ++t) {
        for (std::size_t i = 0; i < n_; ++i) {
          for (std::size_t j = 0; j < n_; ++j) {
            m[(s * n_ + i) * size + t * n_ + j] =
                (s == t && i == j ? 1 : 0) - h * a[s * stages + t] * jacobian_[i * n_ + j];
          }
        }
      }
    }
    return true;
  }
  void solve(Use use, std::span<double> x) override {
    const std::vector<double> result = solved(matrix_[static_cast<int>(use)], {x.begin(), x.end()});
    std::copy(result.begin(), result.end(), x.begin());
  }
  long evaluations = 0;

 private:
  std::size_t n_;
  Rate f_;
  Jacobian df_;
  std::vector<double> jacobian_, matrix_[2];
};

/// Integrates to `end` with steps of the control's choice; the error's scale is the tolerance times |y| +
/// floor.
std::vector<double> integrated(Stiff& flow, std::vector<double> y, double end, double tolerance,
                               const std::vector<double>& floor, long& steps) {
  const std::size_t n = y.size();
  Radau method(n);
  std::vector<double> first(n);
  std::vector<double> scale(n);
  double time = 0, h = 1e-6;
  bool again = true;
  for (steps = 0; time < end && steps < 100000;) {
    for (std::size_t i = 0; i < n; ++i) scale[i] = tolerance * (std::abs(y[i]) + floor[i]);
    flow.rate(time, y, first);
    flow.linearise(time, y);
    h = std::min(h, end - time);
    const bool found = method.step(flow, time, h, y, first, scale);
    const double error =
        found ? method.error(flow, time, h, y, first, scale, again) : std::numeric_limits<double>::infinity();
    again = error > 1;
    if (error <= 1) {
      for (std::size_t i = 0; i < n; ++i) y[i] += method.increment()[i];
      time = end - time == h ? end : time + h;
      ++steps;
    } else {
      method.forget();
    }
    h *= StepControl::sixth_order(error);
  }
  return y;
}

TEST(Radau, IsOfOrderNine) {
  // x'' = -x from x = 1, one step of h: errors go with h^10.
  const auto error_of = [](double h) {
    Stiff flow(
        2, [](auto y, auto out) { out[0] = y[1], out[1] = -y[0]; },
        [](auto, auto out) { out[0] = out[3] = 0, out[1] = 1, out[2] = -1; });
    Radau method(2);
    std::vector<double> first(2);
    const std::vector<double> y{1, 0}, scale{1e-14, 1e-14};
    flow.rate(0, y, first);
    flow.linearise(0, y);
    EXPECT_TRUE(method.step(flow, 0, h, y, first, scale));
    return std::abs(method.increment()[1] + std::sin(h)) + std::abs(1 + method.increment()[0] - std::cos(h));
  };
  const double order = std::log2(error_of(2) / error_of(1)) - 1;
  EXPECT_GT(order, 8.5);
  EXPECT_LT(order, 9.5);
}

TEST(Radau, DampsAFastModeAtOnce) {
  Stiff flow(
      1, [](auto y, auto out) { out[0] = -1e8 * (y[0] - 2); }, [](auto, auto out) { out[0] = -1e8; });
  Radau method(1);
  std::vector<double> first(1);
  const std::vector<double> y{3}, scale{1e-12};
  flow.rate(0, y, first);
  flow.linearise(0, y);
  ASSERT_TRUE(method.step(flow, 0, 1, y, first, scale));
  EXPECT_NEAR(3 + method.increment()[0], 2, 1e-7);  // R(-1e8) is about 5/1e8
}

TEST(Radau, VanDerPolAtItsPublishedDigits) {
  // mu^2 = 1e6, y(0) = (2, 0), t = 2. Source: F. Mazzia, C. Magherini, Test Set for Initial Value Problem
  // Solvers, release 2.4, problem VDPOL.
  constexpr double mu = 1e6;
  Stiff flow(
      2, [](auto y, auto out) { out[0] = y[1], out[1] = mu * ((1 - y[0] * y[0]) * y[1] - y[0]); },
      [](auto y, auto out) {
        out[0] = 0, out[1] = 1, out[2] = mu * (-2 * y[0] * y[1] - 1), out[3] = mu * (1 - y[0] * y[0]);
      });
  long steps = 0;
  const auto y = integrated(flow, {2, 0}, 2, 1e-10, {1, 1}, steps);
  EXPECT_NEAR(y[0], 0.1706167732170483e1, 1e-10);
  EXPECT_NEAR(y[1], -0.8928097010247975, 1e-10);
  EXPECT_LT(steps, 1000);
}

TEST(Radau, RobertsonAtItsPublishedDigits) {
  // t = 1e11. Source: as above, problem ROBER.
  Stiff flow(
      3,
      [](auto y, auto out) {
        const double slow = 0.04 * y[0], back = 1e4 * y[1] * y[2], fast = 3e7 * y[1] * y[1];
        out[0] = -slow + back, out[1] = slow - back - fast, out[2] = fast;
      },
      [](auto y, auto out) {
        const double r[9] = {-0.04,       1e4 * y[2], 1e4 * y[1], 0.04, -1e4 * y[2] - 6e7 * y[1],
                             -1e4 * y[1], 0,          6e7 * y[1], 0};
        std::copy(r, r + 9, out.begin());
      });
  long steps = 0;
  const auto y = integrated(flow, {1, 0, 0}, 1e11, 1e-10, {1e-10, 1e-14, 1e-10}, steps);
  EXPECT_NEAR(y[0], 0.2083340149701255e-7, 1e-9 * 0.2083e-7);
  EXPECT_NEAR(y[1], 0.8333360770334713e-13, 1e-9 * 0.8333e-13);
  EXPECT_NEAR(y[2], 0.9999999791665050, 1e-12);
  EXPECT_LT(steps, 1000);
}

TEST(Radau, PolynomialPassesThroughTheStages) {
  // y' = 5 t^4: of degree 5 itself.
  Stiff flow(
      2, [](auto y, auto out) { out[0] = 1, out[1] = 5 * y[0] * y[0] * y[0] * y[0]; },
      [](auto y, auto out) { out[0] = out[1] = out[3] = 0, out[2] = 20 * y[0] * y[0] * y[0]; });
  Radau method(2);
  std::vector<double> first(2);
  StepPolynomial path(2);
  const std::vector<double> y{0, 3}, scale{1e-15, 1e-15};
  flow.rate(0, y, first);
  flow.linearise(0, y);
  ASSERT_TRUE(method.step(flow, 0, 2, y, first, scale));
  method.polynomial(path);
  for (const double s : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(path.at(s, 0), 2 * s, 1e-14) << s;
    EXPECT_NEAR(path.at(s, 1), static_cast<double>(power(2 * s, 5)), 1e-12) << s;
  }
}

}  // namespace
}  // namespace plumb
