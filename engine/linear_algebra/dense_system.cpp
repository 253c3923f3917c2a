#include "engine/linear_algebra/dense_system.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace plumb {
namespace {

// Systems up to kCompletePivotingSize unknowns use complete pivoting. In larger ones a pivot may be smaller
// than the largest remaining entry by the factor kPivotThreshold. Growth stays small, and the rank is that of
// complete pivoting unless entries are within this factor of rounding.
constexpr std::size_t kCompletePivotingSize = 64;
constexpr double kPivotThreshold = 0.1;

}  // namespace

std::size_t DenseSystem::factor(std::size_t size, std::span<const double> matrix, double dependent) {
  assert(matrix.size() == size * size);
  size_ = size;
  original_.assign(matrix.begin(), matrix.end());
  work_.resize(size);
  components_.compute(size, matrix);
  if (parts_.size() < components_.count()) parts_.resize(components_.count());
  double largest = 0;
  for (const double x : original_) largest = std::max(largest, std::abs(x));
  rank_ = 0;
  for (std::size_t p = 0; p < components_.count(); ++p) {
    Part& part = parts_[p];
    const std::span<const std::size_t> rows = components_.component(p);
    part.size = rows.size();
    components_.extract(p, original_, part.lu);
    part.factor(dependent * largest);
    for (std::size_t i = 0; i < part.size; ++i)
      part.row[i] = rows[part.row[i]], part.column[i] = rows[part.column[i]];
    rank_ += part.rank;
  }
  assert(rank_ <= size);
  return rank_;
}

/// Prepares the elimination of the whole matrix.
void DenseSystem::Part::begin() {
  rank = 0;
  largest.assign(size, 0.0);
  row.resize(size);
  if (entries.size() < size) entries.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    row[i] = i;
    entries[i].clear();
    for (std::size_t j = 0; j < size; ++j) {
      const double entry = std::abs(lu[i * size + j]);
      if (entry == 0) continue;
      entries[i].push_back(j);
      largest[i] = std::max(largest[i], entry);
    }
  }
  column = place = row;
}

void DenseSystem::Part::factor(double least) {
  begin();
  for (; rank < size; ++rank) {
    const auto largest_row =
        std::max_element(largest.begin() + static_cast<std::ptrdiff_t>(rank), largest.end());
    if (!(*largest_row > least)) break;
    move_pivot(static_cast<std::size_t>(largest_row - largest.begin()));
    eliminate();
  }
  // So far, only `column` records how columns were exchanged: now move them.
  std::vector<double>& own = largest;
  for (std::size_t i = 0; i < size; ++i) {
    const auto begin = lu.begin() + static_cast<std::ptrdiff_t>(i * size);
    own.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
    for (std::size_t j = 0; j < size; ++j) lu[i * size + j] = own[column[j]];
  }
}

/// Moves a pivot to the place `rank`. In small systems it is the largest entry, the first in row order of
/// equals. In large ones it is in the row with the fewest entries among the rows whose largest entry is not
/// much smaller than that: the diagonal, if that is large enough, otherwise the row's largest entry. This
/// preserves zeros (H. M. Markowitz, Management Science 3, 1957; with a threshold as in I. S. Duff, A. M.
/// Erisman, J. K. Reid, Direct Methods for Sparse Matrices, 1986, ch. 7).
void DenseSystem::Part::move_pivot(std::size_t from_row) {
  const bool sparse = size > kCompletePivotingSize;
  const double min_pivot = kPivotThreshold * largest[from_row];
  for (std::size_t i = rank; sparse && i < size; ++i) {
    if (largest[i] >= min_pivot && entries[i].size() < entries[from_row].size()) from_row = i;
  }
  const double* own = lu.data() + from_row * size;
  std::size_t from_column = size - 1;
  for (const std::size_t unknown : entries[from_row]) {
    if (place[unknown] < from_column && std::abs(own[unknown]) == largest[from_row])
      from_column = place[unknown];
  }
  const std::size_t diagonal = row[from_row];
  if (sparse && place[diagonal] >= rank && std::abs(own[diagonal]) >= min_pivot)
    from_column = place[diagonal];

  if (from_row != rank) {
    const auto begin_of = [&](std::size_t i) { return lu.begin() + static_cast<std::ptrdiff_t>(i * size); };
    std::swap_ranges(begin_of(from_row), begin_of(from_row + 1), begin_of(rank));
  }
  std::swap(row[from_row], row[rank]);
  std::swap(entries[from_row], entries[rank]);
  std::swap(largest[from_row], largest[rank]);
  std::swap(column[from_column], column[rank]);
  std::swap(place[column[from_column]], place[column[rank]]);
}

/// Eliminates the pivot's unknown from the rows below. In a heap each contact touches few others: most rows
/// do not contain the unknown, and the others change only where the pivot's row has entries.
void DenseSystem::Part::eliminate() {
  assert(rank < size);
  const double* pivots = lu.data() + rank * size;
  const std::size_t eliminated = column[rank];
  assert(pivots[eliminated] != 0);
  std::erase(entries[rank], eliminated);
  for (std::size_t i = rank + 1; i < size; ++i) {
    double* own = lu.data() + i * size;
    if (own[eliminated] == 0) continue;
    const double factor = own[eliminated] /= pivots[eliminated];
    for (const std::size_t unknown : entries[rank]) {
      if (own[unknown] == 0) entries[i].push_back(unknown);
      own[unknown] -= factor * pivots[unknown];
    }
    std::erase_if(entries[i],
                  [&](std::size_t unknown) { return unknown == eliminated || own[unknown] == 0; });
    largest[i] = 0;
    for (const std::size_t unknown : entries[i]) largest[i] = std::max(largest[i], std::abs(own[unknown]));
  }
}

void DenseSystem::Part::solve(std::span<double> b, std::span<double> work) const {
  for (std::size_t i = 0; i < size; ++i) {
    work[i] = b[row[i]];
    for (std::size_t j = 0; j < std::min(i, rank); ++j) work[i] -= lu[i * size + j] * work[j];
  }
  for (std::size_t i = rank; i-- > 0;) {
    for (std::size_t j = i + 1; j < rank; ++j) work[i] -= lu[i * size + j] * work[j];
    work[i] /= lu[i * size + i];
  }
  for (std::size_t i = 0; i < size; ++i) b[column[i]] = i < rank ? work[i] : 0.0;
}

void DenseSystem::solve(std::span<double> b) const {
  assert(b.size() == size_);
  for (std::size_t p = 0; p < components_.count(); ++p) parts_[p].solve(b, work_);
}

void DenseSystem::solve_refined(std::span<double> b) {
  residual_.assign(b.begin(), b.end());
  solve(b);
  for (std::size_t i = 0; i < size_; ++i) {
    for (std::size_t j = 0; j < size_; ++j) residual_[i] -= original_[i * size_ + j] * b[j];
  }
  solve(residual_);
  for (std::size_t i = 0; i < size_; ++i) b[i] += residual_[i];
}

}  // namespace plumb
