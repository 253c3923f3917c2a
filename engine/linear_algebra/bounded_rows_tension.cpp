#include "engine/linear_algebra/bounded_rows.h"

// Rows that contradict each other: a body between a wall and what moves towards it. The regularisation
// answers a contradiction with 1 / kSharing of the impulse that would stop the motion, which presses on both
// sides and moves nothing. Each solve adds to the impulses of the last, and when one of the rows ends, the
// other throws the body out: heaps between a wall and a turning paddle were left at 1e5 m/s.
namespace plumb {
namespace {

// Bounds the residual of a free row that still counts as solved, relative to the row with the largest energy.
// A row at this bound has an impulse of at most 1e-4 / kSharing = 1000 times that row's. With 1e-5, taut
// bridges of 24 and 40 planks under heavy crates lost pulls that they need, and opened by 6 and 1 % of a
// plank.
constexpr double kContradiction = 1e-4;

}  // namespace

// Returns true if free rows do not get what they want.
bool BoundedRows::contradicted() const {
  if (!shares_) return false;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i)
    if (rows[i].state == BoundedRow::kFree && matters(i, residual(i), kContradiction)) return true;
  return false;
}

// Lets rows want what they got, and relaxes the impulses that give it towards 0: along the way to those of
// least size, which the rows between their bounds have in closed form, up to the bounds that are in the way.
void BoundedRows::release_tension() {
  for (int i = 0; i < static_cast<int>(rows.size()); ++i)
    if (rows[i].state == BoundedRow::kFree) rows[i].wanted -= residual(i);
  for (BoundedRow& row : rows) row.softening += kSharing;
  minimise_free();
  for (BoundedRow& row : rows) row.softening -= kSharing;
}

}  // namespace plumb
