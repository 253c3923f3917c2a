#include <algorithm>
#include <cassert>
#include <limits>

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

// Removes rows that are no longer free from the factors. Returns false if other rows are free that the
// factors lack, or if factorising anew is cheaper.
bool BoundedRows::remove_from_factors() {
  if (!factorised_ || free_matrix_.has_dependent_rows()) return false;
  int kept = 0, removed = 0, first = 0;
  double removing = 0;
  for (int k = static_cast<int>(free_.size()) - 1; k >= 0; --k) {
    const bool is_free = rows[free_[k]].state == BoundedRow::kFree;
    if (free_matrix_.is_removed(k)) {
      if (is_free) return false;
      continue;
    }
    if (is_free) {
      ++kept;
    } else {
      ++removed, first = k, removing += 2 * static_cast<double>(free_matrix_.entries(k + 1));
    }
  }
  for (const BoundedRow& row : rows)
    if (row.state == BoundedRow::kFree) --kept;
  if (kept != 0) return false;
  if (removing > free_matrix_.cost(first) + static_cast<double>(free_matrix_.entries())) return false;
  effort += removing;
  for (int k = first; removed > 0; ++k) {
    if (free_matrix_.is_removed(k) || rows[free_[k]].state == BoundedRow::kFree) continue;
    free_matrix_.remove(k), --removed;
  }
  return true;
}

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

// Moves the free rows to `from_` plus a fraction of the step x_, within their bounds.
void BoundedRows::step_from(double fraction) {
  for (std::size_t k = 0; k < free_.size(); ++k) {
    BoundedRow& row = rows[free_[k]];
    const double impulse = std::min(std::max(from_[k].impulse + fraction * x_[k], row.lower), row.upper);
    apply_impulse(row, impulse - row.impulse);
    row.impulse = impulse;
  }
}

// Returns the coupling of two free rows, given by their places in free_.
double BoundedRows::free_coupling(int place, int other) const {
  const int row = free_positions_[std::max(place, other)], column = free_positions_[std::min(place, other)];
  return column >= full_matrix_.first(row) ? full_matrix_.at(row, column) : 0;
}

// Returns the fraction of the step x_, up to 1, at which the energy has its first minimum if each row stops
// at its bound, and sets `stops_`, the rows that stop before. The whole step lowers the residuals by
// themselves, up to the regularisation, so the energy can be followed from stop to stop without passes over
// the rows: only the couplings of the rows that have stopped are needed.
double BoundedRows::best_step_fraction() {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const int count = static_cast<int>(free_.size());
  const auto own = [&](int k) {
    const BoundedRow& row = rows[free_[k]];
    return mobility_[free_[k]] + (row.compliance + mobility_[free_[k]] * row.softening);
  };
  // The factors are those of rows with the regularisation, which the energy has only while infeasible rows
  // are relaxed.
  const auto change_of = [&](int k) {
    const int position = free_positions_[k];
    const double regularisation = regularised_ ? kRegularisation * mobility_[free_[k]] : 0;
    return from_[k].residual - (full_matrix_.at(position, position) + regularisation - own(k)) * x_[k];
  };
  stops_.clear(), stops_.reserve(rows.size());
  int left = 0;
  for (int k = 0; k < count; ++k) {
    const BoundedRow& row = rows[free_[k]];
    double& reach = from_[k].reach = kNever;
    if (row.impulse + x_[k] < row.lower) reach = (row.lower - row.impulse) / x_[k];
    if (row.impulse + x_[k] > row.upper) reach = (row.upper - row.impulse) / x_[k];
    if (reach < kNever) ++left;
  }
  if (left == 0) return 1;
  // Step of the moving rows times their residuals at the start, and times what the whole step takes from
  // them.
  double moving = 0, moving_change = 0;
  for (int k = 0; k < count; ++k) moving += x_[k] * from_[k].residual, moving_change += x_[k] * change_of(k);
  double fraction = 0, slope = moving, curvature = moving_change;  // -dE/dt = slope - t curvature
  for (; left > 0; --left) {
    int next = -1;
    for (int k = 0; k < count; ++k)
      if (from_[k].reach < kNever && (next < 0 || from_[k].reach < from_[next].reach)) next = k;
    const double reach = from_[next].reach;
    if (!stops_.empty() && !(slope - reach * curvature > 0)) return std::max(fraction, slope / curvature);
    fraction = reach, from_[next].reach = kNever;
    assert(!(fraction < 0 || fraction > 1));  // NaN, after an overflow: quarantined later
    Stop stop{next, reach, x_[next], change_of(next)};
    moving -= stop.step * from_[next].residual, moving_change -= stop.step * stop.change;
    for (Stop& other : stops_) {
      const double coupling = free_coupling(next, other.place);
      other.change -= stop.step * coupling, stop.change -= other.step * coupling;
    }
    stop.change -= stop.step * own(next);
    stops_.push_back(stop);
    slope = moving, curvature = moving_change;
    for (const Stop& each : stops_)
      slope -= each.reach * each.step * each.change, curvature -= each.step * each.change;
    if (!(slope - fraction * curvature > 0)) return fraction;
  }
  return slope - curvature > 0 ? 1 : std::max(fraction, slope / curvature);
}

// Steps to the minimum over the rows that are between their bounds, or towards it for as long as the energy
// falls. Returns false if bounds limited the step; the rows that reached them are now there.
bool BoundedRows::minimise_on_face() {
  for (BoundedRow& row : rows) {
    // Pivots leave impulses beyond bounds by what they tolerate. A row of the factors that is held there
    // would reach its bound at an infinite fraction of its step, 0.
    const double within = std::min(std::max(row.impulse, row.lower), row.upper);
    apply_impulse(row, within - row.impulse);
    row.impulse = within;
    row.state = row.impulse <= row.lower   ? BoundedRow::kLower
                : row.impulse >= row.upper ? BoundedRow::kUpper
                                           : BoundedRow::kFree;
  }
  factorise();
  x_.resize(free_.size()), from_.resize(free_.size());
  for (int refinement = 0; refinement <= kRefinements; ++refinement) {
    bool exact = true;
    count_passes(2), count_solution();
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const BoundedRow& row = rows[free_[k]];
      x_[k] = row.state == BoundedRow::kFree ? residual(free_[k]) : 0;
      from_[k] = {row.impulse, x_[k], 0};
      exact = exact && !is_significant(free_[k], x_[k], kResidualTolerance);
    }
    if (exact) return true;
    free_matrix_.solve(x_.data());
    step_from(best_step_fraction());
    for (const Stop& stop : stops_) {
      BoundedRow& row = rows[free_[stop.place]];
      const double bound = stop.step > 0 ? row.upper : row.lower;
      apply_impulse(row, bound - row.impulse);
      row.impulse = bound;
    }
    if (!stops_.empty()) return false;
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
