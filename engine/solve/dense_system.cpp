#include "engine/solve/dense_system.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace plumb {

std::size_t DenseSystem::factor(std::size_t size, std::span<const double> matrix, double dependent) {
  size_ = size;
  original_.assign(matrix.begin(), matrix.end());
  lu_ = original_;
  row_.resize(size);
  column_.resize(size);
  std::iota(row_.begin(), row_.end(), std::size_t{0});
  std::iota(column_.begin(), column_.end(), std::size_t{0});
  work_.resize(size);
  double largest = 0;
  for (const double x : lu_) largest = std::max(largest, std::abs(x));
  for (rank_ = 0; rank_ < size; ++rank_) {
    std::size_t best_row = rank_, best_column = rank_;
    double best = 0;
    for (std::size_t i = rank_; i < size; ++i) {
      for (std::size_t j = rank_; j < size; ++j) {
        const double x = std::abs(lu_[i * size + j]);
        if (x > best) best = x, best_row = i, best_column = j;
      }
    }
    if (!(best > dependent * largest)) break;
    for (std::size_t j = 0; j < size; ++j) std::swap(lu_[best_row * size + j], lu_[rank_ * size + j]);
    for (std::size_t i = 0; i < size; ++i) std::swap(lu_[i * size + best_column], lu_[i * size + rank_]);
    std::swap(row_[best_row], row_[rank_]);
    std::swap(column_[best_column], column_[rank_]);
    eliminate(rank_);
  }
  return rank_;
}

void DenseSystem::eliminate(std::size_t k) {
  for (std::size_t i = k + 1; i < size_; ++i) {
    double& factor = lu_[i * size_ + k];
    factor /= lu_[k * size_ + k];
    if (factor == 0) continue;
    for (std::size_t j = k + 1; j < size_; ++j) lu_[i * size_ + j] -= factor * lu_[k * size_ + j];
  }
}

void DenseSystem::solve(std::span<double> b) const {
  for (std::size_t i = 0; i < size_; ++i) {
    work_[i] = b[row_[i]];
    for (std::size_t j = 0; j < std::min(i, rank_); ++j) work_[i] -= lu_[i * size_ + j] * work_[j];
  }
  for (std::size_t i = rank_; i-- > 0;) {
    for (std::size_t j = i + 1; j < rank_; ++j) work_[i] -= lu_[i * size_ + j] * work_[j];
    work_[i] /= lu_[i * size_ + i];
  }
  for (std::size_t i = 0; i < size_; ++i) b[column_[i]] = i < rank_ ? work_[i] : 0.0;
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
