#include "engine/linear_algebra/banded_lu.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace plumb {
namespace {

/// Numbers in [-1, 1), the same ones each time.
struct Numbers {
  std::uint32_t state = 12345;
  double next() {
    state = state * 1664525u + 1013904223u;
    return static_cast<double>(state) / 2147483648.0 - 1;
  }
};

TEST(BandedLu, SolvesAlsoWhereRowsMustBeExchanged) {
  for (const std::size_t n : {1, 2, 7, 40}) {
    for (const std::size_t below : {0, 1, 3}) {
      for (const std::size_t above : {0, 2, 5}) {
        if (below >= n || above >= n) continue;
        Numbers numbers;
        BandedLu matrix;
        matrix.reset(n, below, above);
        std::vector<double> dense(n * n, 0), expected(n), x(n, 0);
        for (std::size_t i = 0; i < n; ++i) {
          expected[i] = numbers.next();
          for (std::size_t j = i > below ? i - below : 0; j <= std::min(n - 1, i + above); ++j) {
            // Small diagonals: without exchanges of rows nothing would be left of the digits.
            const bool diagonal = i == j && below > 0 && above > 0;
            dense[i * n + j] = matrix.at(i, j) =
                numbers.next() * (diagonal ? 1e-14 : 1) + (below == 0 || above == 0 ? 3 * (i == j) : 0);
          }
        }
        for (std::size_t i = 0; i < n; ++i) {
          for (std::size_t j = 0; j < n; ++j) x[i] += dense[i * n + j] * expected[j];
        }
        const std::vector<double> right_side = x;
        ASSERT_TRUE(matrix.factor());
        matrix.solve(x);
        for (std::size_t i = 0; i < n;
             ++i) {  // backward stable: residuals of rounding size, whatever the condition
          double residual = -right_side[i], size = 0;
          for (std::size_t j = 0; j < n; ++j) {
            residual += dense[i * n + j] * x[j];
            size = std::max(size, std::abs(x[j]));
          }
          EXPECT_LE(std::abs(residual), 2e-15 * size * static_cast<double>(below + above + 1))
              << n << " " << below << " " << above;
        }
      }
    }
  }
}

TEST(BandedLu, SingularMatrixIsSaidToBe) {
  BandedLu matrix;
  matrix.reset(3, 1, 1);
  matrix.at(0, 0) = matrix.at(0, 1) = matrix.at(1, 0) = matrix.at(1, 1) =
      1;  // two equal rows, and one of zeros
  EXPECT_FALSE(matrix.factor());
  matrix.reset(1, 0, 0);
  matrix.at(0, 0) = std::nan("");
  EXPECT_FALSE(matrix.factor());
}

}  // namespace
}  // namespace plumb
