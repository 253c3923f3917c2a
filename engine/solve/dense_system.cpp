#include "engine/solve/dense_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb {

std::size_t DenseSystem::factor(std::size_t size, std::span<const double> matrix, double dependent) {
  size_ = size;
  original_.assign(matrix.begin(), matrix.end());
  work_.resize(size);
  division_.find(size, matrix);
  if (parts_.size() < division_.count()) parts_.resize(division_.count());
  double largest = 0;
  for (const double x : original_) largest = std::max(largest, std::abs(x));
  rank_ = 0;
  for (std::size_t p = 0; p < division_.count(); ++p) {
    Part& part = parts_[p];
    const std::span<const std::size_t> rows = division_.part(p);
    part.size = rows.size();
    part.row.assign(rows.begin(), rows.end());
    part.column = part.row;
    division_.take(p, original_, part.lu);
    part.factor(dependent * largest);
    rank_ += part.rank;
  }
  return rank_;
}

void DenseSystem::Part::factor(double least) {
  for (rank = 0; rank < size; ++rank) {
    std::size_t best_row = rank, best_column = rank;
    double best = 0;
    for (std::size_t i = rank; i < size; ++i) {
      for (std::size_t j = rank; j < size; ++j) {
        const double x = std::abs(lu[i * size + j]);
        if (x > best) best = x, best_row = i, best_column = j;
      }
    }
    if (!(best > least)) break;
    for (std::size_t j = 0; j < size; ++j) std::swap(lu[best_row * size + j], lu[rank * size + j]);
    for (std::size_t i = 0; i < size; ++i) std::swap(lu[i * size + best_column], lu[i * size + rank]);
    std::swap(row[best_row], row[rank]);
    std::swap(column[best_column], column[rank]);
    eliminate(rank);
  }
}

void DenseSystem::Part::eliminate(std::size_t k) {
  for (std::size_t i = k + 1; i < size; ++i) {
    double& factor = lu[i * size + k];
    factor /= lu[k * size + k];
    if (factor == 0) continue;
    for (std::size_t j = k + 1; j < size; ++j) lu[i * size + j] -= factor * lu[k * size + j];
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
  for (std::size_t p = 0; p < division_.count(); ++p) parts_[p].solve(b, work_);
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
