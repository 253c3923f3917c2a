#pragma once

#include <algorithm>

namespace plumb {

// Largest number of rows of a small system. It is factorised in the order of its rows, on the stack: at most
// 700 multiplications, about the cost of finding an elimination order.
inline constexpr int kSmallRows = 16;
// Smallest pivot, relative to its diagonal, of a system that needs no regularisation. With a thousandth of
// this value, refinement would leave errors of 1e-9.
inline constexpr double kMinPivot = 1e-4;

/// A symmetric matrix of few rows. Each row is stored from its first entry to the diagonal; all rows have the
/// same width.
struct SmallMatrix {
  double value[kSmallRows][kSmallRows];  // not initialised
  double inverse_pivot[kSmallRows];
  int first[kSmallRows];

  // Factorises the first `count` rows in place, as L D L^T. Returns false if a pivot is small.
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
      if (!(pivot > kMinPivot * diagonal)) return false;
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
