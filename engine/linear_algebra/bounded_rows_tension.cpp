#include "engine/linear_algebra/bounded_rows.h"

// Rows that contradict each other: a body between a wall and what moves towards it. The regularisation
// answers a contradiction with 1 / kSharing of the impulse that would stop the motion, which presses on both
// sides and moves nothing. Each solve adds to the impulses of the last, and when one of the rows ends, the
// other throws the body out: heaps between a wall and a turning paddle were left at 1e5 m/s.
namespace plumb {

// Returns true if free rows do not get what they want. A residual of kClear leaves impulses of at most
// kClear / kSharing, a hundred times those of the row with the largest energy.
bool BoundedRows::contradicted() const {
  if (!shares_) return false;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i)
    if (rows[i].state == BoundedRow::kFree && matters(i, residual(i), kClear)) return true;
  return false;
}

// Lets rows want what they got: this they can have. Of the impulses that give it, finds those next to 0.
void BoundedRows::release_tension() {
  x_.assign(rows.size(), 0);
  for (int i = 0; i < static_cast<int>(rows.size()); ++i)
    if (rows[i].state == BoundedRow::kFree) x_[i] = residual(i);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].wanted -= x_[i], rows[i].impulse = 0;
  set_fixed();
  find_impulses();
}

}  // namespace plumb
