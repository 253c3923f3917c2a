// Rows that others leave almost nothing of: from which share on they count, to 2 % of the threshold.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/linear_algebra/dense_system.h"
#include "engine/linear_algebra/envelope_matrix.h"
#include "engine/linear_algebra/joint_system.h"

namespace plumb {
namespace {

// Two rows of one body, (1, 0) and (1, e): the second has e^2/(1 + e^2) of itself to itself. `beside` more
// rows of other bodies, so that both ways to factorise are taken: hinges alone, and rows of any kind.
template <class Real>
std::vector<Row<Real>> almost_parallel(double share, int beside) {
  const Real e = static_cast<Real>(std::sqrt(share / (1 - share)));
  std::vector<Row<Real>> rows = {{kFixedFrame, 0, {-1, 0}, {1, 0}, 0, 0, 0, 0},
                                 {kFixedFrame, 0, {-1, -e}, {1, e}, 0, 0, 0, 0}};
  for (int i = 0; i < beside; ++i) rows.push_back({kFixedFrame, 1 + i, {-1, 0}, {1, 0}, 0, 0, 0, 0});
  return rows;
}

template <class Real>
JointSystem<Real> system_for(const std::vector<Row<Real>>& rows) {
  const std::vector<Real> one(rows.size(), Real(1));
  return JointSystem<Real>(rows, one, one);
}

/// Returns how many rows depend on others; checks the solution for (0, 1), which is (-1/e^2, 1/e^2) if both
/// count.
template <class Real>
int dependent_at(double share, Real least_share = 0) {
  int counted = -1;
  for (const int beside : {0, 1}) {
    const std::vector<Row<Real>> rows = almost_parallel<Real>(share, beside);
    JointSystem<Real> system = system_for(rows);
    system.set_pivot_threshold(least_share);
    const int dependent = system.factor(rows);
    EXPECT_TRUE(counted < 0 || counted == dependent) << "with other rows beside";
    counted = dependent;
    std::vector<Real> x(rows.size(), Real(0));
    x[1] = 1;
    system.solve(x);
    // A few of e^2's digits are there: 1/2 epsilon of 1 beside it.
    const double exact = dependent > 0 ? 0 : (1 - share) / share;
    const double digits = std::numeric_limits<Real>::epsilon() / share;
    if (dependent == 0) {
      EXPECT_NEAR(static_cast<double>(x[1] + x[0]), 0, 2 * digits * exact);
    }
    EXPECT_NEAR(static_cast<double>(std::min(std::abs(x[0]), std::abs(x[1]))), exact, 2 * digits * exact);
  }
  return counted;
}

TEST(Redundancy, ARowCountsThatKeepsAFewOfItsDigits) {
  const double in_double = 4096 * std::numeric_limits<double>::epsilon();
  EXPECT_EQ(dependent_at<double>(1.02 * in_double), 0);
  EXPECT_EQ(dependent_at<double>(0.98 * in_double), 1);
  const double in_float = 64 * std::numeric_limits<float>::epsilon();
  EXPECT_EQ(dependent_at<float>(1.02 * in_float), 0);
  EXPECT_EQ(dependent_at<float>(0.98 * in_float), 1);
  EXPECT_EQ(dependent_at<double>(0.5), 0);
}

TEST(Redundancy, ALeastShareIsTheOneThatWasGiven) {
  for (const double share : {1e-6, 1e-3, 0.1}) {
    EXPECT_EQ(dependent_at<double>(1.02 * share, share), 0);
    EXPECT_EQ(dependent_at<double>(0.98 * share, share), 1);
  }
  EXPECT_EQ(dependent_at<float>(1.02e-2, 1e-2f), 0);
  EXPECT_EQ(dependent_at<float>(0.98e-2, 1e-2f), 1);
}

TEST(Redundancy, RowsThatStayDependentDoSoUntilTheyAreReleased) {
  for (const int beside : {0, 1}) {
    const std::vector<Row<double>> near = almost_parallel<double>(1e-16, beside),
                                   apart = almost_parallel<double>(0.5, beside);
    JointSystem<double> system = system_for(near);
    EXPECT_EQ(system.factor(near), 1);
    system.freeze_dependent();
    EXPECT_EQ(system.frozen_count(), 1);
    EXPECT_EQ(system.factor(apart), 1);
    system.release_dependent();
    EXPECT_EQ(system.frozen_count(), 0);
    EXPECT_EQ(system.factor(apart), 0);
    EXPECT_NEAR(system.min_pivot_ratio(), 0.5, 1e-12);
  }
}

// [1 1; 1 1 + d]: elimination leaves d of 1 + d.
TEST(Redundancy, DenseSystemsCountWhatIsMoreThanRounding) {
  const auto rank = [](double d, auto... dependent) {
    DenseSystem system;
    return system.factor(2, std::vector<double>{1, 1, 1, 1 + d}, dependent...);
  };
  EXPECT_EQ(rank(1.02e-12), 2u);
  EXPECT_EQ(rank(0.98e-12), 1u);
  EXPECT_EQ(rank(1.02e-6, 1e-6), 2u);
  EXPECT_EQ(rank(0.98e-6, 1e-6), 1u);
}

TEST(Redundancy, EnvelopesCountWhatIsMoreThanRounding) {
  const auto second = [](double d) {
    EnvelopeMatrix matrix;
    matrix.reset(std::vector<int>{0, 0});
    matrix.at(0, 0) = 1, matrix.at(1, 0) = 1, matrix.at(1, 1) = 1 + d;
    matrix.factorise();
    double x[] = {0, 1};
    matrix.solve(x);
    EXPECT_NEAR(x[0], -x[1], 1e-12 * std::abs(x[1]));
    return x[1] * d;
  };
  EXPECT_NEAR(second(1.02e-12), 1, 1e-3);
  EXPECT_EQ(second(0.98e-12), 0);
}

}  // namespace
}  // namespace plumb
