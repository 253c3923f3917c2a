#include "engine/linear_algebra/complementarity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "engine/linear_algebra/dense_system.h"
#include "engine/precise/events/coulomb.h"

namespace plumb {
namespace {

using Status = ComplementaritySolution::Status;

std::vector<double> w_of(const std::vector<double>& m, const std::vector<double>& q,
                         const std::vector<double>& z) {
  std::vector<double> w = q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) w[i] += m[i * q.size() + j] * z[j];
  }
  return w;
}

TEST(Complementarity, SmallProblemsByHand) {
  // One unknown: z = max(0, -q/m).
  EXPECT_EQ(solve_complementarity(std::vector{2.0}, std::vector{3.0}).z[0], 0);
  EXPECT_DOUBLE_EQ(solve_complementarity(std::vector{2.0}, std::vector{-3.0}).z[0], 1.5);
  // Two: z = (4/3, 7/3) solves M z = -q.
  const auto two = solve_complementarity(std::vector{2.0, 1.0, 1.0, 2.0}, std::vector{-5.0, -6.0});
  EXPECT_NEAR(two.z[0], 4.0 / 3, 1e-15);
  EXPECT_NEAR(two.z[1], 7.0 / 3, 1e-15);
  // No solution: w = -z - 1 is negative for every z >= 0.
  EXPECT_NE(solve_complementarity(std::vector{-1.0}, std::vector{-1.0}).status, Status::Solved);
}

TEST(Complementarity, RandomSemidefiniteProblemsOfAnyRank) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 300; ++round) {
    const std::size_t n = 1 + static_cast<std::size_t>(round) % 20,
                      rank = 1 + static_cast<std::size_t>(round) % 7;
    std::vector<double> j(n * rank), m(n * n, 0.0), q(n);
    for (double& x : j) x = normal(random);
    std::vector<double> pull(rank);
    for (double& x : pull) x = normal(random);
    for (std::size_t a = 0; a < n; ++a) {
      q[a] = 0;
      for (std::size_t k = 0; k < rank; ++k) q[a] += j[a * rank + k] * pull[k];  // then a solution exists
      for (std::size_t b = 0; b < n; ++b) {
        for (std::size_t k = 0; k < rank; ++k) m[a * n + b] += j[a * rank + k] * j[b * rank + k];
      }
    }
    const auto solution = solve_complementarity(m, q);
    ASSERT_EQ(solution.status, Status::Solved) << round;
    const auto w = w_of(m, q, solution.z);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_GE(solution.z[i], 0);
      EXPECT_GE(w[i], -1e-9) << round;
      EXPECT_NEAR(w[i] * solution.z[i], 0, 1e-8) << round;
    }
  }
}

TEST(DenseSystem, SolvesAndFindsTheRank) {
  DenseSystem system;
  EXPECT_EQ(system.factor(2, std::vector{0.0, 2.0, 4.0, 1.0}), 2u);
  std::vector<double> b{6, 11};
  system.solve_refined(b);
  EXPECT_DOUBLE_EQ(b[0], 2);
  EXPECT_DOUBLE_EQ(b[1], 3);
  // x + y = 2 twice: one unknown is zero, and the equations hold.
  EXPECT_EQ(system.factor(2, std::vector{1.0, 1.0, 1.0, 1.0}), 1u);
  b = {2, 2};
  system.solve(b);
  EXPECT_DOUBLE_EQ(b[0] + b[1], 2);
}

/// Neighbours in a row, `reach` to either side, shuffled, so that the order of elimination decides how many
/// zeros remain; every `twice`th equation and unknown is there twice.
struct Row {
  std::size_t size = 0;
  std::vector<double> matrix;
};

Row neighbours(std::size_t size, std::size_t reach, std::size_t twice, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<std::size_t> place(size);
  for (std::size_t i = 0; i < size; ++i) place[i] = i;
  std::shuffle(place.begin(), place.end(), random);
  std::vector<double> half(size * size);  // of A = H H^T
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = i; j <= std::min(i + reach, size - 1); ++j)
      half[i * size + j] = i == j ? 2 : unit(random);
    if (i % twice == 1) std::copy_n(half.begin() + (i - 1) * size, size, half.begin() + i * size);
  }
  Row row{size, std::vector<double>(size * size)};
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < size; ++k) sum += half[i * size + k] * half[j * size + k];
      row.matrix[place[i] * size + place[j]] = sum;
    }
  }
  return row;
}

TEST(DenseSystem, SolvesLargeSystemsOfNeighboursAndFindsTheirRank) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  DenseSystem system;
  for (const std::size_t size : {64, 65, 90, 240}) {
    const std::size_t twice = 15;
    const Row row = neighbours(size, 3, twice, random);
    std::vector<double> x(size), b(size);
    for (double& value : x) value = unit(random);
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j < size; ++j) b[i] += row.matrix[i * size + j] * x[j];
    EXPECT_EQ(system.factor(size, row.matrix), size - (size + twice - 2) / twice) << size;
    std::vector<double> found = b;
    system.solve_refined(found);
    for (std::size_t i = 0; i < size;
         ++i) {  // which of the unknowns that are there twice is zero is not said
      double residual = b[i];
      for (std::size_t j = 0; j < size; ++j) residual -= row.matrix[i * size + j] * found[j];
      EXPECT_NEAR(residual, 0, 1e-13) << size;
    }
  }
}

/// A point mass on a plane: normal and tangent do not mix.
CoulombProblem point(double friction, double press, double drag, int slip = 0) {
  return {{0}, {{friction, slip}}, {1, 0, 0, 1}, {press, drag}};
}

TEST(Coulomb, StickSlipAndSeparation) {
  const auto stick = solve_coulomb(point(0.5, -10, 4));
  EXPECT_EQ(stick.mode[0], 0);
  EXPECT_NEAR(stick.force[0], 10, 1e-14);
  EXPECT_NEAR(stick.force[1], -4, 1e-14);
  const auto slips = solve_coulomb(point(0.5, -10, 6));
  EXPECT_EQ(slips.mode[0], 1);
  EXPECT_NEAR(slips.force[1], -5, 1e-14);
  EXPECT_NEAR(slips.rate[1], 1, 1e-14);
  EXPECT_EQ(solve_coulomb(point(0.5, -10, -6)).mode[0], -1);
  const auto opens = solve_coulomb(point(0.5, 10, 6));
  EXPECT_EQ(opens.active[0], 0);
  EXPECT_EQ(opens.force[1], 0);
  // Slip that goes on, whatever its rate.
  EXPECT_NEAR(solve_coulomb(point(0.5, -10, 1, -1)).force[1], 5, 1e-14);
}

TEST(Coulomb, PainlevesParadoxIsSeen) {
  // A uniform rod of length 2 at 45 degrees that slips at mu = 2: W_nn = 1 + 3 cos^2, W_nt = -3 sin cos; the
  // response under friction is negative, so that with q < 0 there is no force, and with q > 0 two answers.
  const double nn = 2.5, nt = -1.5, tt = 2.5;
  CoulombProblem problem{{0}, {{2, -1}}, {nn, nt, nt, tt}, {-1, 0}};
  EXPECT_FALSE(solve_coulomb(problem).solved);
  problem.rate = {1, 0};
  const auto several = solve_coulomb(problem);
  EXPECT_TRUE(several.solved);
  EXPECT_TRUE(several.ambiguous);
  EXPECT_EQ(several.force[0], 0) << "the one that separates";
}

}  // namespace
}  // namespace plumb
