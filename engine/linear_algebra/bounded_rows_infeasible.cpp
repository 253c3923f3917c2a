#include <utility>

#include "engine/linear_algebra/bounded_rows.h"

// Infeasible rows: no impulses reach their targets, as for a body between a wall and a kinematic body that
// moves towards it. The regularised system then returns 1 / kRegularisation of the impulse that would stop
// the motion, on both sides, which moves nothing. It grows from solve to solve, and when one of the rows
// ends, the other accelerates the body: heaps between a wall and a rotating paddle were left at 1e5 m/s.
namespace plumb {
namespace {

// Bounds the residual of a free row that still counts as solved, relative to the row with the largest energy.
// A row at this bound has an impulse of at most 1e-4 / kRegularisation = 1000 times that row's. With 1e-5,
// taut bridges of 24 and 40 planks under heavy crates lost pulls that they need, and opened by 6 and 1 % of a
// plank.
constexpr double kInfeasibleResidual = 1e-4;
// Passes of projected Gauss-Seidel after impulses were scaled. Without any, one of 48 crates that are pulled
// into a floor reached 29 sizes a second instead of 16.
constexpr int kPasses = 10;

}  // namespace

// Returns true if free rows miss their targets.
bool BoundedRows::is_infeasible() const {
  if (!regularised_) return false;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i)
    if (rows[i].state == BoundedRow::kFree && is_significant(i, residual(i), kInfeasibleResidual))
      return true;
  return false;
}

// Sets the targets of free rows to the velocities that they reached, and reduces the impulses that give
// these: moves them towards the smallest ones, which free rows have in closed form, up to their bounds. If
// neither pivots nor descent had found a solution, these may gain energy over the targets that were asked
// for. Then scales them until they gain none, and improves them by passes that lower the energy further.
void BoundedRows::relax_infeasible_rows() {
  targets_.clear();
  for (const BoundedRow& row : rows) targets_.push_back(row.target);
  for (int i = 0; i < static_cast<int>(rows.size()); ++i)
    if (rows[i].state == BoundedRow::kFree) rows[i].target -= residual(i);
  for (BoundedRow& row : rows) row.softening += kRegularisation;
  minimise_free();
  for (BoundedRow& row : rows) row.softening -= kRegularisation;
  const auto swap_targets = [&] {
    for (std::size_t i = 0; i < rows.size(); ++i) std::swap(rows[i].target, targets_[i]);
  };
  swap_targets();
  if (energy() > 0) scale_impulses(), gauss_seidel(kPasses);
  swap_targets();
}

}  // namespace plumb
