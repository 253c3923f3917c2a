#include "engine/linear_algebra/envelope_matrix.h"

#include <algorithm>
#include <cassert>

namespace plumb {
namespace {

// Sums four products at a time, in an order that does not depend on the compiler or the vector width.
double dot_in_fours(const double* a, const double* b, int count) {
  double sums[4] = {0, 0, 0, 0};
  int i = 0;
  for (; i + 4 <= count; i += 4)
    for (int lane = 0; lane < 4; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  double remainder = 0;
  for (; i < count; ++i) remainder += a[i] * b[i];
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + remainder;
}

// The rows of chains and trees are short.
inline double dot_product(const double* a, const double* b, int count) {
  if (count >= 4) return dot_in_fours(a, b, count);
  double remainder = 0;
  for (int i = 0; i < count; ++i) remainder += a[i] * b[i];
  return remainder;
}

}  // namespace

void EnvelopeMatrix::reset(std::span<const int> first) {
  shape(first);
  std::fill(values_.begin(), values_.end(), 0.0);
}

void EnvelopeMatrix::shape(std::span<const int> first) {
  first_columns_.assign(first.begin(), first.end());
  row_starts_.resize(first.size());
  int next = 0;
  for (int i = 0; i < size(); ++i) {
    row_starts_[i] = next;
    assert(first_columns_[i] >= 0 && first_columns_[i] <= i);
    next += i - first_columns_[i] + 1;
  }
  values_.resize(static_cast<std::size_t>(next));
  inverse_pivots_.resize(first.size());
}

double EnvelopeMatrix::factorise(int from) {
  // Pivots below this fraction of the diagonal count as zero: the row depends on others, up to rounding.
  constexpr double kDependentPivot = 1e-12;
  double min_ratio = 1;
  if (from == 0) has_dependent_rows_ = false;
  for (int i = from; i < size(); ++i) {
    double* row = &values_[row_starts_[i]] - first_columns_[i];
    const double diagonal = row[i];
    assert(!(diagonal < 0));  // positive definite; NaN: quarantined later
    // row[j] <- (L D)_ij = a_ij - sum_k (L D)_ik L_jk
    for (int j = first_columns_[i]; j < i; ++j) {
      const double* above = &values_[row_starts_[j]] - first_columns_[j];
      const int k = std::max(first_columns_[i], first_columns_[j]);
      row[j] -= dot_product(row + k, above + k, j - k);
    }
    double pivot = diagonal;
    for (int j = first_columns_[i]; j < i; ++j) {
      const double l = row[j] * inverse_pivots_[j];
      pivot -= l * row[j];
      row[j] = l;
    }
    const bool independent = pivot > kDependentPivot * diagonal;
    inverse_pivots_[i] = independent ? 1 / pivot : 0;
    if (!independent) {
      min_ratio = 0, has_dependent_rows_ = true;
    } else if (pivot < min_ratio * diagonal) {
      min_ratio = pivot / diagonal;
    }
  }
  return min_ratio;
}

// Adds the removed row's part d l l^T, with l its column of L, back to the factors of the rows behind it
// (Gill, Golub, Murray and Saunders, Mathematics of Computation 28, 1974, method C1). It is positive, so
// pivots only grow.
void EnvelopeMatrix::remove(int removed) {
  assert(!has_dependent_rows_ && !is_removed(removed));
  steps_.resize(first_columns_.size());
  double added = 1 / inverse_pivots_[removed];
  inverse_pivots_[removed] = 0;
  double* const own = &values_[row_starts_[removed]] - first_columns_[removed];
  std::fill(own + first_columns_[removed], own + removed, 0.0);
  for (int i = removed + 1; i < size(); ++i) {
    double* row = &values_[row_starts_[i]] - first_columns_[i];
    double entry = 0;
    if (first_columns_[i] <= removed) entry = row[removed], row[removed] = 0;
    for (int j = std::max(first_columns_[i], removed + 1); j < i; ++j) {
      entry -= steps_[j].entry * row[j];
      row[j] += steps_[j].gain * entry;
    }
    steps_[i] = {entry, 0};
    if (entry == 0 || is_removed(i)) {
      steps_[i].entry = 0;
      continue;
    }
    // d <- d + a e^2, and of what is added to later rows, a, remains a d / (d + a e^2).
    const double inverse = inverse_pivots_[i], grown = 1 + added * entry * entry * inverse;
    inverse_pivots_[i] = inverse / grown;
    steps_[i].gain = added * entry * inverse_pivots_[i];
    added /= grown;
  }
}

void EnvelopeMatrix::solve(double* x) const {
  for (int i = 0; i < size(); ++i) {
    const double* row = &values_[row_starts_[i]] - first_columns_[i];
    x[i] -= dot_product(row + first_columns_[i], x + first_columns_[i], i - first_columns_[i]);
  }
  for (int i = 0; i < size(); ++i) x[i] *= inverse_pivots_[i];
  for (int i = size() - 1; i >= 0; --i) {
    const double* row = &values_[row_starts_[i]] - first_columns_[i];
    const double xi = x[i];
    for (int j = first_columns_[i]; j < i; ++j) x[j] -= row[j] * xi;
  }
}

double EnvelopeMatrix::cost(std::span<const int> first, int from) {
  double sum = 0;
  for (std::size_t i = static_cast<std::size_t>(from); i < first.size(); ++i) {
    const double width = static_cast<double>(i) - first[i];
    sum += 0.5 * width * width;
  }
  return sum;
}

}  // namespace plumb
