#include "engine/linear_algebra/matrix_components.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <vector>

#include "engine/linear_algebra/complementarity.h"
#include "engine/linear_algebra/dense_system.h"

namespace plumb {
namespace {

using Matrix = std::vector<double>;

std::vector<std::size_t> part(const MatrixComponents& parts, std::size_t p) {
  return {parts.component(p).begin(), parts.component(p).end()};
}

TEST(MatrixComponents, FollowEntriesEitherWay) {
  // 0 to 3 by an entry above the diagonal, 3 to 5 by one below it; 1 and 4; 2 alone, without a diagonal.
  const std::size_t n = 6;
  Matrix m(n * n);
  for (const std::size_t i : {0, 1, 3, 4, 5}) m[i * n + i] = 1;
  m[0 * n + 3] = m[5 * n + 3] = m[4 * n + 1] = 1e-300;
  MatrixComponents parts;
  parts.compute(n, m);
  ASSERT_EQ(parts.count(), 3u);
  EXPECT_EQ(part(parts, 0), (std::vector<std::size_t>{0, 3, 5}));
  EXPECT_EQ(part(parts, 1), (std::vector<std::size_t>{1, 4}));
  EXPECT_EQ(part(parts, 2), (std::vector<std::size_t>{2}));
  Matrix own;
  parts.extract(0, m, own);
  EXPECT_EQ(own, (Matrix{1, 1e-300, 0, 0, 1, 0, 0, 1e-300, 1}));
  parts.compute(0, {});
  EXPECT_EQ(parts.count(), 0u);
}

/// Positive definite blocks of sizes 1 to 4 whose rows lie mixed.
Matrix mixed(std::size_t n, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Matrix m(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j)
      if (i % 4 == j % 4) m[i * n + j] = m[j * n + i] = i == j ? 4 : unit(random);
  }
  return m;
}

TEST(MatrixComponents, SystemsOfPartsAreSolved) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  DenseSystem system;
  for (const std::size_t n : {14, 3, 9}) {  // one after the other in the same room
    const Matrix m = mixed(n, random);
    std::vector<double> x(n), b(n);
    for (double& value : x) value = unit(random);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) b[i] += m[i * n + j] * x[j];
    EXPECT_EQ(system.factor(n, m), n);
    system.solve_refined(b);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(b[i], x[i], 1e-15) << n;
  }
  // A part that is next to nothing beside the others depends on rounding: its unknown is zero.
  EXPECT_EQ(system.factor(2, Matrix{1, 0, 0, 1e-13}), 1u);
  std::vector<double> b{2, 1};
  system.solve(b);
  EXPECT_EQ(b, (std::vector<double>{2, 0}));
}

TEST(MatrixComponents, ComplementarityOfPartsHolds) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 50; ++round) {
    const std::size_t n = 15;
    const Matrix m = mixed(n, random);
    std::vector<double> q(n);
    for (double& value : q) value = unit(random);
    const ComplementaritySolution found = solve_complementarity(m, q);
    ASSERT_EQ(found.status, ComplementaritySolution::Status::Solved);
    for (std::size_t i = 0; i < n; ++i) {
      double w = q[i];
      for (std::size_t j = 0; j < n; ++j) w += m[i * n + j] * found.z[j];
      EXPECT_GE(found.z[i], 0);
      EXPECT_GE(w, -1e-15);
      EXPECT_NEAR(w * found.z[i], 0, 1e-15);
    }
  }
  // One part without a solution is none of the whole: z_1 >= 0 cannot make w_1 = -z_1 - 1 positive.
  EXPECT_NE(solve_complementarity(Matrix{1, 0, 0, -1}, std::vector<double>{-1, -1}).status,
            ComplementaritySolution::Status::Solved);
}

}  // namespace
}  // namespace plumb
