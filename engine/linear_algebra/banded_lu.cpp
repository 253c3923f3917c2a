#include "engine/linear_algebra/banded_lu.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace plumb {

void BandedLu::reset(std::size_t size, std::size_t below, std::size_t above) {
  assert(size == 0 || (below < size && above < size));
  size_ = size;
  lower_band_ = below;
  upper_band_ = below + above;
  width_ = lower_band_ + upper_band_ + 1;
  entries_.assign(size_ * width_, 0);
  lower_.assign(size_ * lower_band_, 0);
  pivot_.assign(size_, 0);
}

void BandedLu::clear() { std::fill(entries_.begin(), entries_.end(), 0.0); }

bool BandedLu::factor() {
  for (std::size_t k = 0; k < size_; ++k) {
    const std::size_t last_row = std::min(k + lower_band_, size_ - 1), last = last_in(k);
    std::size_t p = k;
    for (std::size_t i = k + 1; i <= last_row; ++i) {
      if (std::abs(at(i, k)) > std::abs(at(p, k))) p = i;
    }
    pivot_[k] = p;
    if (!(std::abs(at(p, k)) > 0) || !std::isfinite(at(p, k))) return false;
    if (p != k) std::swap_ranges(&at(k, k), &at(k, k) + (last - k + 1), &at(p, k));
    const double inverse = 1 / at(k, k);
    const double* upper = &at(k, k);
    for (std::size_t i = k + 1; i <= last_row; ++i) {
      double* row = &at(i, k);
      const double factor = row[0] * inverse;
      lower_[k * lower_band_ + (i - k - 1)] = factor;
      if (factor == 0) continue;
      for (std::size_t j = 1; j <= last - k; ++j) row[j] -= factor * upper[j];
    }
  }
  return true;
}

void BandedLu::solve(std::span<double> x) const {
  assert(x.size() == size_);
  for (std::size_t k = 0; k < size_; ++k) {
    std::swap(x[k], x[pivot_[k]]);
    const std::size_t last_row = std::min(k + lower_band_, size_ - 1);
    for (std::size_t i = k + 1; i <= last_row; ++i) x[i] -= lower_[k * lower_band_ + (i - k - 1)] * x[k];
  }
  for (std::size_t k = size_; k-- > 0;) {
    const double* row = &entries_[k * width_ + lower_band_];
    const std::size_t last = last_in(k);
    double sum = x[k];
    for (std::size_t j = k + 1; j <= last; ++j) sum -= row[j - k] * x[j];
    x[k] = sum / row[0];
  }
}

}  // namespace plumb
