#pragma once

#include <algorithm>

namespace plumb {

// Largest number of rows of a small system, which is factorised as the rows come, on the stack: at most 700
// multiplications, about what finding an order of elimination costs.
inline constexpr int kSmallRows = 16;
// Least pivot, relative to its diagonal, of a system that needs no regularisation: with a thousandth of it
// the refinements would leave 1e-9.
inline constexpr double kLeastPivot = 1e-4;

/// A symmetric matrix of few rows, each stored from its first entry to the diagonal, all of the same width.
struct SmallMatrix {
  double value[kSmallRows][kSmallRows];  // not initialised
  double inverse_pivot[kSmallRows];
  int first[kSmallRows];

  // Factorises the first `count` rows, L D L^T, in place. Returns false if a pivot is small.
  bool factorise(int count) {
    for (int i = 0; i < count; ++i) {
      double* const row = value[i];
      const double diagonal = row[i];
      for (int j = first[i] + 1; j < i; ++j)
        for (int k = std::max(first[i], first[j]); k < j; ++k) row[j] -= row[k] * value[j][k];
      double pivot = diagonal;
      for (int j = first[i]; j < i; ++j) {
        const double l = row[j] * inverse_pivot[j];
        pivot -= l * row[j];
        row[j] = l;
      }
      if (!(pivot > kLeastPivot * diagonal)) return false;
      inverse_pivot[i] = 1 / pivot;
    }
    return true;
  }

  void solve(int count, double* x) const {
    for (int i = 0; i < count; ++i)
      for (int j = first[i]; j < i; ++j) x[i] -= value[i][j] * x[j];
    for (int i = 0; i < count; ++i) x[i] *= inverse_pivot[i];
    for (int i = count - 1; i >= 0; --i)
      for (int j = first[i]; j < i; ++j) x[j] -= value[i][j] * x[i];
  }
};

/// Copies the rows and columns `which`, in ascending order.
inline void gather(const SmallMatrix& from, const int* which, int size, SmallMatrix& to) {
  for (int k = 0; k < size; ++k) {
    const double* const row = from.value[which[k]];
    int first = 0;
    while (which[first] < from.first[which[k]]) ++first;
    to.first[k] = first;
    for (int l = first; l <= k; ++l) to.value[k][l] = row[which[l]];
  }
}

}  // namespace plumb
