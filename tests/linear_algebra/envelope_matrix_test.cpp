#include "engine/linear_algebra/envelope_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

// Rows that are removed from the factors of a matrix. Truth is the system of the rows that remain: the
// solution must meet its equations, evaluated from the entries of the matrix.
namespace plumb {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double in(double a, double b) { return a + (b - a) * (double(engine_() >> 11) * 0x1p-53); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }

 private:
  std::mt19937_64 engine_;
};

struct Problem {
  std::vector<int> first;
  std::vector<std::vector<double>> entries;  // the whole symmetric matrix
  std::vector<bool> removed;
};

// A diagonally dominant matrix, whose diagonal exceeds the sum of the others in its row by `excess` of it.
Problem draw_problem(Draw& of, double excess) {
  Problem out;
  const int size = 1 + of.below(40);
  out.entries.assign(size, std::vector<double>(size, 0.0));
  out.removed.assign(size, false);
  for (int i = 0; i < size; ++i) {
    out.first.push_back(of.below(3) == 0 ? of.below(i + 1) : std::max(0, i - of.below(6)));
    for (int j = out.first[i]; j < i; ++j) out.entries[i][j] = out.entries[j][i] = of.in(-1, 1);
  }
  for (int i = 0; i < size; ++i) {
    double sum = 0.01;
    for (const double entry : out.entries[i]) sum += std::abs(entry);
    out.entries[i][i] = (1 + excess) * sum;
  }
  return out;
}

void fill(const Problem& it, EnvelopeMatrix& matrix) {
  matrix.reset(it.first);
  for (int i = 0; i < matrix.size(); ++i)
    for (int j = it.first[i]; j <= i; ++j) matrix.at(i, j) = it.entries[i][j];
}

// Returns the largest residual of the rows that remain, relative to the right-hand side, or 1 if a removed
// row has an unknown.
double error_of(const Problem& it, const EnvelopeMatrix& matrix, Draw& of) {
  const int size = matrix.size();
  std::vector<double> right(size), x(size);
  for (int i = 0; i < size; ++i) x[i] = right[i] = it.removed[i] ? 0 : of.in(-1, 1);
  matrix.solve(x.data());
  double error = 0;
  for (int i = 0; i < size; ++i) {
    if (it.removed[i]) {
      if (x[i] != 0) return 1;
      continue;
    }
    double sum = -right[i];
    for (int j = 0; j < size; ++j) sum += it.entries[i][j] * x[j];
    error = std::max(error, std::abs(sum));
  }
  return error;
}

TEST(EnvelopeMatrix, SolvesWithoutTheRowsThatAreRemovedFromItsFactors) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Draw of(seed);
    Problem it = draw_problem(of, seed % 2 == 0 ? 1 : 1e-3);
    EnvelopeMatrix matrix;
    fill(it, matrix);
    matrix.factorise();
    EXPECT_FALSE(matrix.has_dependent_rows());
    EXPECT_LT(error_of(it, matrix, of), 1e-11) << "seed " << seed;
    for (int i = matrix.size(); i > 0; --i) {
      const int row = of.below(matrix.size());
      if (matrix.is_removed(row)) continue;
      matrix.remove(row), it.removed[row] = true;
      EXPECT_LT(error_of(it, matrix, of), 1e-11) << "seed " << seed << ", without row " << row;
    }
  }
}

// [1 1; 1 1 + 1e-7]: without the first row the second one's pivot is its diagonal again.
TEST(EnvelopeMatrix, ForgetsARowOnWhichAnotherDepended) {
  EnvelopeMatrix matrix;
  matrix.reset(std::vector<int>{0, 0});
  matrix.at(0, 0) = 1, matrix.at(1, 0) = 1, matrix.at(1, 1) = 1 + 1e-7;
  matrix.factorise();
  matrix.remove(0);
  double x[] = {0, 3};
  matrix.solve(x);
  EXPECT_EQ(x[0], 0);
  EXPECT_NEAR(x[1], 3 / (1 + 1e-7), 1e-14);
}

}  // namespace
}  // namespace plumb
