#include <algorithm>

#include "engine/linear_algebra/bounded_rows.h"

// Gradient projection with subspace minimisation, for systems of which pivots do not end.
namespace plumb {
namespace {

// Rounds of descent, iterations in each round, and the last iterations if the rounds do not converge.
constexpr int kRounds = 3, kSweeps = 3, kLastSweeps = 10;

}  // namespace

// Runs passes of projected Gauss-Seidel, each of which lowers the energy.
void BoundedRows::sweep(int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
      BoundedRow& row = rows[i];
      const double own = mobility_[i] * (1 + row.softening) + row.compliance;
      if (!(own > 0)) continue;
      const double now = std::min(std::max(row.impulse + residual(i) / own, row.lower), row.upper);
      push(row, now - row.impulse);
      row.impulse = now;
    }
  }
}

// Adds a fraction of the step x_ to the free rows.
void BoundedRows::advance(double share) {
  for (std::size_t k = 0; k < free_.size(); ++k) {
    BoundedRow& row = rows[free_[k]];
    const double now = std::min(std::max(row.impulse + share * x_[k], row.lower), row.upper);
    push(row, now - row.impulse);
    row.impulse = now;
  }
}

// Goes to the minimum over the rows between their bounds, or towards it as far as the energy falls.
void BoundedRows::minimise_free() {
  for (BoundedRow& row : rows)
    row.state = row.impulse <= row.lower   ? BoundedRow::kLower
                : row.impulse >= row.upper ? BoundedRow::kUpper
                                           : BoundedRow::kFree;
  factorise();
  x_.resize(free_.size());
  for (int refinement = 0; refinement <= kRefinements; ++refinement) {
    for (std::size_t k = 0; k < free_.size(); ++k) x_[k] = residual(free_[k]);
    matrix_.solve(x_.data());
    double share = 1;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const BoundedRow& row = rows[free_[k]];
      if (row.impulse + x_[k] < row.lower) share = std::min(share, (row.lower - row.impulse) / x_[k]);
      if (row.impulse + x_[k] > row.upper) share = std::min(share, (row.upper - row.impulse) / x_[k]);
    }
    if (share == 1) {
      advance(1);
      continue;
    }
    // Try the whole step, clamped at the bounds; keep it if it is better than the step to the first bound.
    for (std::size_t i = 0; i < rows.size(); ++i) best_[i] = rows[i].impulse;
    advance(share);
    const double near = energy();
    for (std::size_t i = 0; i < rows.size(); ++i) std::swap(best_[i], rows[i].impulse);
    apply_all();
    advance(1);
    if (energy() <= near) return;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].impulse = best_[i];
    apply_all();
    return;
  }
}

// Minimises by gradient projection, from the best impulses known.
void BoundedRows::descend() {
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].impulse = std::min(std::max(best_[i], rows[i].lower), rows[i].upper);
  apply_all();
  shrink();
  for (int round = 0; round < kRounds; ++round) {
    sweep(kSweeps);
    minimise_free();
    if (count_wrong(kSlack) == 0) return;
  }
  sweep(kLastSweeps);
}

}  // namespace plumb
