#include <algorithm>
#include <limits>

#include "engine/linear_algebra/bounded_rows.h"
#include "engine/linear_algebra/row_coupling.h"
#include "engine/linear_algebra/small_matrix.h"

// Systems of few rows, solved without an elimination order.
namespace plumb {

// Runs block pivots on a system of few rows that are far from dependent, without an elimination order,
// regularisation or refinement. Returns false, with the bodies unchanged, if the system is not of this kind
// or the pivots do not end.
bool BoundedRows::solve_small() {
  const int count = static_cast<int>(rows.size());
  if (count > kSmallRows) return false;
  if (count == 1 && rows[0].lower == -std::numeric_limits<double>::infinity() &&
      rows[0].upper == std::numeric_limits<double>::infinity()) {
    BoundedRow& row = rows[0];
    row.impulse = (row.target - row_velocity(row)) / (mobility_[0] * (1 + row.softening) + row.compliance);
    apply_impulse(row, row.impulse);
    return true;
  }
  SmallMatrix all, part;
  int begin[kSmallRows + 1], blocks = 0;
  bool bounded = false;
  for (int i = 0; i < count; ++i) {
    const BoundedRow& row = rows[i];
    if (i == 0 || row.block != rows[i - 1].block) begin[blocks++] = i;
    bounded = bounded || row.lower > -std::numeric_limits<double>::infinity() ||
              row.upper < std::numeric_limits<double>::infinity();
  }
  begin[blocks] = count;
  for (int block = 0; block < blocks; ++block) {
    const int from = begin[block];
    int first = from;
    for (int other = 0; other < block; ++other) {
      const int start = begin[other], size = begin[other + 1] - start;
      const bool coupled = are_neighbours(bodies, rows[from], rows[start]);
      if (coupled) first = std::min(first, start);
      if (start < first) continue;
      for (int i = from; i < begin[block + 1]; ++i) {
        if (coupled) {
          couple(bodies, rows[i], &rows[start], size, all.value[i] + start);
        } else {
          std::fill_n(all.value[i] + start, size, 0.0);
        }
      }
    }
    for (int i = from; i < begin[block + 1]; ++i) {
      const BoundedRow& row = rows[i];
      double* const to = all.value[i];
      all.first[i] = first;
      for (int j = from; j < i; ++j) to[j] = coupling(bodies, row, rows[j]);
      to[i] = mobility_[i] * (1 + row.softening) + row.compliance;
    }
  }
  if (bounded) compute_energy_scale();
  int free_rows[kSmallRows];
  double x[kSmallRows];
  for (int pivots = 0; pivots < kMaxPivots; ++pivots) {
    int size = 0;
    bool held = false;
    for (int i = 0; i < count; ++i) {
      BoundedRow& row = rows[i];
      if (row.state == BoundedRow::kFree) {
        row.impulse = 0, free_rows[size++] = i;
      } else {
        row.impulse = row.state == BoundedRow::kLower ? row.lower : row.upper;
        held = held || row.impulse != 0;
      }
    }
    if (held) apply_all();
    for (int k = 0; k < size; ++k) x[k] = residual(free_rows[k]);
    if (bounded) gather(all, free_rows, size, part);
    SmallMatrix& free = bounded ? part : all;  // without bounds all rows are free and remain so
    const bool regular = free.factorise(size);
    if (regular) {
      free.solve(size, x);
      for (int k = 0; k < size; ++k) {
        rows[free_rows[k]].impulse = x[k];
        apply_impulse(rows[free_rows[k]], x[k]);
      }
      if (!bounded) return true;
      if (count_violations(kTolerance) == 0) {
        if (held) scale_impulses();
        return true;
      }
      for (int i = 0; i < count; ++i)
        if (next_state_[i] != 0) rows[i].state = static_cast<BoundedRow::State>(next_state_[i] - 1);
    }
    std::copy(start_.begin(), start_.end(), bodies.begin());
    if (!regular) return false;
  }
  return false;
}

}  // namespace plumb
