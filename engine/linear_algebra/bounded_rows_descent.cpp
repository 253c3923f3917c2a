#include <algorithm>

#include "engine/linear_algebra/bounded_rows.h"

// Gradient projection with subspace minimisation (active sets), for systems that pivoting does not solve.
namespace plumb {
namespace {

// Number of rounds of descent; iterations in each; iterations at the end if the rounds do not converge.
constexpr int kRounds = 10, kSmoothingIterations = 3, kFinalIterations = 10;
// Number of steps to a bound that a descent may make when the effort has reached its limit.
constexpr int kLeastFaces = 2;
// Tolerated violation, relative to the row with the largest energy v^2 / mobility. In wedged bodies impulses
// are a thousand times the load, and the regularisation of dependent rows leaves errors of 1e-7 of them. At
// 1e-8 a third of the descents of two wedged ragdolls do not end, at 1e-6 one in twenty.
constexpr double kDescentTolerance = 1e-6;

}  // namespace

// Runs passes of projected Gauss-Seidel, each of which lowers the energy.
void BoundedRows::gauss_seidel(int iterations) {
  count_passes(2 * iterations);
  for (int pass = 0; pass < iterations; ++pass) {
    for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
      BoundedRow& row = rows[i];
      const double diagonal = mobility_[i] * (1 + row.softening) + row.compliance;
      if (!(diagonal > 0)) continue;
      const double impulse = std::min(std::max(row.impulse + residual(i) / diagonal, row.lower), row.upper);
      apply_impulse(row, impulse - row.impulse);
      row.impulse = impulse;
    }
  }
}

// Adds a fraction of the step x_ to the free rows.
void BoundedRows::apply_step(double fraction) {
  for (std::size_t k = 0; k < free_.size(); ++k) {
    BoundedRow& row = rows[free_[k]];
    const double impulse = std::min(std::max(row.impulse + fraction * x_[k], row.lower), row.upper);
    apply_impulse(row, impulse - row.impulse);
    row.impulse = impulse;
  }
}

// Returns the largest fraction of the step x_, up to 1, that keeps the free rows within their bounds.
double BoundedRows::max_step_fraction() const {
  double fraction = 1;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const BoundedRow& row = rows[free_[k]];
    if (row.impulse + x_[k] < row.lower) fraction = std::min(fraction, (row.lower - row.impulse) / x_[k]);
    if (row.impulse + x_[k] > row.upper) fraction = std::min(fraction, (row.upper - row.impulse) / x_[k]);
  }
  return fraction;
}

// Steps to the minimum over the rows that are between their bounds, or towards it for as long as the energy
// falls. Returns false if a bound limited the step; that row is now at its bound.
bool BoundedRows::minimise_on_face() {
  for (BoundedRow& row : rows)
    row.state = row.impulse <= row.lower   ? BoundedRow::kLower
                : row.impulse >= row.upper ? BoundedRow::kUpper
                                           : BoundedRow::kFree;
  factorise();
  x_.resize(free_.size());
  for (int refinement = 0; refinement <= kRefinements; ++refinement) {
    bool exact = true;
    count_passes(2), count_solution();
    for (std::size_t k = 0; k < free_.size(); ++k) {
      x_[k] = residual(free_[k]);
      exact = exact && !is_significant(free_[k], x_[k], kResidualTolerance);
    }
    if (exact) return true;
    free_matrix_.solve(x_.data());
    const double fraction = max_step_fraction();
    if (fraction == 1) {
      apply_step(1);
      continue;
    }
    count_passes(5);
    // Try the whole step, clamped at the bounds; keep it if it is better than the step to the first bound.
    for (std::size_t i = 0; i < rows.size(); ++i) best_[i] = rows[i].impulse;
    apply_step(fraction);
    const double energy_at_bound = energy();
    for (std::size_t i = 0; i < rows.size(); ++i) std::swap(best_[i], rows[i].impulse);
    apply_all();
    apply_step(1);
    if (energy() <= energy_at_bound) return false;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].impulse = best_[i];
    apply_all();
    return false;
  }
  return true;
}

// Finds the minimum over the rows that are between their bounds; fixes each row whose bound is reached on the
// way.
void BoundedRows::minimise_free() {
  const int most = static_cast<int>(rows.size());
  for (int face = 0; face <= (is_exhausted() ? kLeastFaces : most) && !minimise_on_face(); ++face) continue;
}

// Minimises the energy over the impulses within their bounds, starting from the present ones.
void BoundedRows::descend() {
  for (int round = 0; round < (is_exhausted() ? 1 : kRounds); ++round) {
    if (round > 0) gauss_seidel(kSmoothingIterations);
    minimise_free();
    if (count_violations(kDescentTolerance) == 0) return;
  }
  gauss_seidel(kFinalIterations);
  if (is_exhausted()) minimise_free();
}

}  // namespace plumb
