#include "engine/linear_algebra/bounded_rows.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/linear_algebra/row_coupling.h"
#include "engine/linear_algebra/small_matrix.h"

namespace plumb {
namespace {

// Returns the mobility of a row, J M^-1 J^T. Returns 0 if locked axes leave only the rounding of the row's
// direction, because the square of that rounding may be tiny.
double mobility_of(std::span<const BoundedBody> bodies, const BoundedRow& row) {
  constexpr double kRounding = 1e-30;
  const double along = coupling(bodies, row, row);
  const auto mobility_bound = [](const BoundedBody& body, Vec2d linear, double angular) {
    return std::max(body.inverse_mass.x, body.inverse_mass.y) * length_squared(linear) +
           body.inverse_inertia * angular * angular;
  };
  const BoundedBody &a = bodies[row.a], &b = bodies[row.b];
  if (a.inverse_mass.x == a.inverse_mass.y && b.inverse_mass.x == b.inverse_mass.y) return along;
  const double bound =
      mobility_bound(a, row.linear_a, row.angular_a) + mobility_bound(b, row.linear_b, row.angular_b);
  return along > kRounding * bound ? along : 0;
}

}  // namespace

BoundedRows::BoundedRows(std::pmr::memory_resource* memory)
    : bodies(memory),
      rows(memory),
      displacements(memory),
      order_(memory),
      full_matrix_(memory),
      free_matrix_(memory),
      start_(memory),
      mobility_(memory),
      block_first_(memory),
      free_(memory),
      free_positions_(memory),
      block_positions_(memory),
      rows_in_order_(memory),
      free_before_(memory),
      first_columns_(memory),
      x_(memory),
      guess_(memory),
      best_(memory),
      from_(memory),
      stops_(memory),
      targets_(memory),
      next_state_(memory) {}

double BoundedRows::order(std::span<const std::pair<int, int>> blocks, std::span<const int> sizes) {
  assert(blocks.size() == sizes.size());
  std::pmr::vector<std::pair<int, int>> body_blocks(rows.get_allocator());
  const int count = static_cast<int>(blocks.size());
  for (int block = 0; block < count; ++block) {
    if (bodies[blocks[block].first].is_dynamic()) body_blocks.emplace_back(blocks[block].first, block);
    if (bodies[blocks[block].second].is_dynamic()) body_blocks.emplace_back(blocks[block].second, block);
  }
  order_.compute(count, body_blocks);
  block_positions_.assign(count, 0);
  int next = 0;
  for (const int block : order_.sequence()) block_positions_[block] = next, next += sizes[block];
  first_columns_.clear();
  for (const int block : order_.sequence()) {
    int first = block_positions_[block];
    for (const int other : order_.neighbours(block)) first = std::min(first, block_positions_[other]);
    for (int i = 0; i < sizes[block]; ++i) first_columns_.push_back(first);
  }
  return EnvelopeMatrix::cost(first_columns_);
}

void BoundedRows::compute_mobility() {
  assert(std::all_of(rows.begin(), rows.end(), [&](const BoundedRow& row) {
    const int count = static_cast<int>(bodies.size());
    return row.a >= 0 && row.a < count && row.b >= 0 && row.b < count;
  }));
  assert(std::all_of(rows.begin(), rows.end(), [](const BoundedRow& row) { return row.compliance >= 0; }));
  mobility_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    mobility_[i] = mobility_of(bodies, rows[i]);
    assert(!(mobility_[i] < 0));  // NaN, after an overflow: quarantined later
  }
}

// Finds the largest energy v^2 / mobility of a row, or what the caller gave. The speed at which a one-sided
// row may close does not count: that of a rope's least length, metres away, is a thousand times the motion's,
// and residuals as large as the motion would then pass as solved.
void BoundedRows::compute_energy_scale() {
  energy_scale_ = min_energy_scale_;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double target = is_one_sided(rows[i]) ? std::max(rows[i].target, 0.0) : std::abs(rows[i].target);
    const double speed = std::max(std::abs(row_velocity(rows[i])), target);
    if (speed * speed > energy_scale_ * mobility_[i] && mobility_[i] > 0)
      energy_scale_ = speed * speed / mobility_[i];
  }
}

// Finds the first row of each block.
void BoundedRows::index_blocks() {
  const int blocks = static_cast<int>(order_.sequence().size());
  block_first_.assign(blocks + 1, 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    assert(rows[i].block >= 0 && rows[i].block < blocks);
    block_first_[rows[i].block + 1] = static_cast<int>(i) + 1;
  }
  for (int block = 0; block < blocks; ++block)
    block_first_[block + 1] = std::max(block_first_[block + 1], block_first_[block]);
}

void BoundedRows::assemble() {
  index_blocks();
  rows_in_order_.clear(), first_columns_.clear();
  for (const int block : order_.sequence()) {
    block_positions_[block] = static_cast<int>(rows_in_order_.size());
    for (int i = block_first_[block]; i < block_first_[block + 1]; ++i) rows_in_order_.push_back(i);
  }
  for (const int i : rows_in_order_) {
    int first = block_positions_[rows[i].block];
    for (const int other : order_.neighbours(rows[i].block)) first = std::min(first, block_positions_[other]);
    first_columns_.push_back(first);
  }
  assert(rows_in_order_.size() == rows.size());
  full_matrix_.reset(first_columns_);
  for (int position = 0; position < static_cast<int>(rows_in_order_.size()); ++position) {
    const int i = rows_in_order_[position];
    const BoundedRow& row = rows[i];
    const auto couple_with = [&](int block) {
      const int from = block_positions_[block];
      const int count = std::min(block_first_[block + 1] - block_first_[block], position + 1 - from);
      couple(bodies, row, rows.data() + block_first_[block], count,
             full_matrix_.row(position) + from - full_matrix_.first(position));
    };
    couple_with(row.block);
    for (const int other : order_.neighbours(row.block)) couple_with(other);
    full_matrix_.at(position, position) = mobility_[i] + (row.compliance + mobility_[i] * row.softening);
  }
  assembled_ = true, factorised_ = regularised_ = false;
}

// Factorises the free rows, with regularisation if they depend on each other. Rows before the first one whose
// state has changed keep their factors.
void BoundedRows::factorise() {
  if (remove_from_factors()) return;
  const int count = static_cast<int>(rows_in_order_.size());
  free_positions_.resize(count), first_columns_.resize(count), free_before_.resize(count);
  int free_count = 0;
  for (int position = 0; position < count; ++position) {
    free_before_[position] = free_count;
    if (rows[rows_in_order_[position]].state != BoundedRow::kFree) continue;
    free_positions_[free_count] = position;
    first_columns_[free_count++] = free_before_[full_matrix_.first(position)];
  }
  free_positions_.resize(free_count), first_columns_.resize(free_count);
  int unchanged = 0;
  const int known = factorised_ ? std::min(free_count, static_cast<int>(free_.size())) : 0;
  while (unchanged < known && free_[unchanged] == rows_in_order_[free_positions_[unchanged]] &&
         !free_matrix_.is_removed(unchanged))
    ++unchanged;
  free_.resize(free_count);
  for (int k = unchanged; k < free_count; ++k) free_[k] = rows_in_order_[free_positions_[k]];
  free_matrix_.shape(first_columns_);
  effort += EnvelopeMatrix::cost(first_columns_, unchanged) + static_cast<double>(free_matrix_.entries());
  if (!regularised_) {
    copy_free_rows(unchanged);
    regularised_ = !(free_matrix_.factorise(unchanged) > kMinPivot);
    if (regularised_) unchanged = 0;
  }
  if (regularised_) {
    copy_free_rows(unchanged);
    for (int k = unchanged; k < static_cast<int>(free_.size()); ++k)
      free_matrix_.at(k, k) += kRegularisation * mobility_[free_[k]];
    free_matrix_.factorise(unchanged);
  }
  factorised_ = true;
}

// Copies the rows and columns of the free rows, starting at free row `from`.
void BoundedRows::copy_free_rows(int from) {
  const bool all_free = free_positions_.size() == rows_in_order_.size();
  for (int k = from; k < static_cast<int>(free_positions_.size()); ++k) {
    double* to = free_matrix_.row(k);
    if (all_free) {
      std::copy_n(full_matrix_.row(k), k + 1 - first_columns_[k], to);
    } else {
      const double* row = full_matrix_.row(free_positions_[k]) - full_matrix_.first(free_positions_[k]);
      for (int j = first_columns_[k]; j <= k; ++j) *to++ = row[free_positions_[j]];
    }
  }
}

double BoundedRows::unbounded_impulse(int i) const {
  const double response = (1 + rows[i].softening) * mobility_[i] + rows[i].compliance;
  return rows[i].impulse + (response > 0 ? residual(i) / response : 0);
}

// Returns true if a row's speed is more than `fraction` of that of the row with the largest energy.
bool BoundedRows::is_significant(int i, double speed, double fraction) const {
  return speed * speed > fraction * fraction * energy_scale_ * mobility_[i];
}

// Adds the effort of passes over all rows, or of a solution with the factors, to that of all solutions.
void BoundedRows::count_passes(int passes) {
  constexpr double kPassEffort = 8;  // of one row, in multiplications of a factorisation
  effort += kPassEffort * passes * static_cast<double>(rows.size());
}
void BoundedRows::count_solution() { effort += 2 * static_cast<double>(free_matrix_.entries()); }

// Sets the bodies' velocities from all present impulses.
void BoundedRows::apply_all() {
  std::copy(start_.begin(), start_.end(), bodies.begin());
  for (const BoundedRow& row : rows) apply_impulse(row, row.impulse);
}

// Solves for the impulses of the free rows, given those of the others. If free rows depend on each other,
// finds the solution nearest to `guess_`, up to the error of the regularisation.
void BoundedRows::solve_free() {
  if (regularised_ && !guess_set_) prepare_guess();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    BoundedRow& row = rows[i];
    if (row.state == BoundedRow::kFree) {
      row.impulse = regularised_ ? guess_[i] : 0;
    } else {
      row.impulse = row.state == BoundedRow::kLower ? row.lower : row.upper;
    }
  }
  apply_all();
  refine();
}

// Makes one step of iterative refinement of the free rows. Returns false if their residuals are small
// already.
bool BoundedRows::refine() {
  count_passes(1);
  bool exact = true;
  x_.resize(free_.size());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    x_[k] = rows[free_[k]].state == BoundedRow::kFree ? residual(free_[k]) : 0;
    exact = exact && !is_significant(free_[k], x_[k], kResidualTolerance);
  }
  if (exact) return false;
  count_solution();
  free_matrix_.solve(x_.data());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    rows[free_[k]].impulse += x_[k];
    apply_impulse(rows[free_[k]], x_[k]);
  }
  return true;
}

// Counts the rows that violate their bounds or inequality by more than `slack`, and records the state that
// each should have.
int BoundedRows::count_violations(double slack) {
  int count = 0;
  next_state_.assign(rows.size(), 0);
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const BoundedRow& row = rows[i];
    int to = -1;
    if (row.state == BoundedRow::kFree) {
      if (row.impulse < row.lower && is_significant(i, (row.lower - row.impulse) * mobility_[i], slack))
        to = BoundedRow::kLower;
      if (row.impulse > row.upper && is_significant(i, (row.impulse - row.upper) * mobility_[i], slack))
        to = BoundedRow::kUpper;
    } else if (row.lower < row.upper) {
      const double missing = residual(i);
      if (row.state == BoundedRow::kLower && missing > 0 && is_significant(i, missing, slack))
        to = BoundedRow::kFree;
      if (row.state == BoundedRow::kUpper && missing < 0 && is_significant(i, missing, slack))
        to = BoundedRow::kFree;
    }
    if (to < 0) continue;
    next_state_[i] = static_cast<std::int8_t>(to + 1);
    ++count;
  }
  return count;
}

// Returns two sums: the work x . (target - J v) of the impulses on the target velocities, and x . A x, that
// on the velocities that they cause.
BoundedRows::Work BoundedRows::work() const {
  Work out;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const BoundedRow& row = rows[i];
    if (row.impulse == 0) continue;
    const BoundedBody &a = start_[row.a], &b = start_[row.b];
    const double before = dot(row.linear_a, a.velocity) + row.angular_a * a.spin +
                          dot(row.linear_b, b.velocity) + row.angular_b * b.spin;
    const double target = row.impulse * (row.target - before);
    out.linear += target;
    out.quadratic += target - row.impulse * residual(i);
  }
  return out;
}

// Returns 1/2 x A x - x (target - J v), which solutions minimise.
double BoundedRows::energy() const {
  const Work w = work();
  return 0.5 * w.quadratic - w.linear;
}

// Scales all impulses by the factor that minimises the energy. Then x A x = x (target - J v), so they gain no
// energy, even far from the solution: where rows are infeasible, or the factorisation is inexact.
void BoundedRows::scale_impulses() {
  const Work w = work();
  if (!(w.quadratic > w.linear + kTolerance * std::abs(w.linear))) return;
  // x A x is never negative except by rounding; the quotient of two roundings could be any number.
  const double fraction = w.quadratic > 0 ? std::max(w.linear / w.quadratic, 0.0) : 0.0;
  for (BoundedRow& row : rows) row.impulse *= fraction;
  apply_all();
}

// Runs block pivots; returns true if they end in a solution.
bool BoundedRows::pivot() {
  guess_set_ = false;
  best_.resize(rows.size());
  int min_violations = std::numeric_limits<int>::max();
  for (int pivots = 0; pivots < kMaxPivots; ++pivots) {
    factorise();
    solve_free();
    int violations = count_violations(regularised_ ? kClearViolation : kTolerance);
    if (violations == 0 && regularised_) {
      for (int i = 0; i < kRefinements && refine(); ++i) continue;
      violations = count_violations(kTolerance);
    }
    if (violations == 0) return true;
    if (violations < min_violations) {
      min_violations = violations;
      for (std::size_t i = 0; i < rows.size(); ++i) best_[i] = rows[i].impulse;
    }
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (next_state_[i] != 0) rows[i].state = static_cast<BoundedRow::State>(next_state_[i] - 1);
  }
  return false;
}

// Sets `guess_` to the fraction of the initial impulses that gains no energy.
void BoundedRows::prepare_guess() {
  guess_set_ = true;
  if (std::all_of(guess_.begin(), guess_.end(), [](double impulse) { return impulse == 0; })) return;
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].impulse = guess_[i];
  apply_all();
  scale_impulses();
  for (std::size_t i = 0; i < rows.size(); ++i) guess_[i] = rows[i].impulse;
}

// Sets the states of rows with nothing to solve for: those that no impulse can move, or whose bounds
// coincide.
void BoundedRows::set_fixed() {
  guess_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    BoundedRow& row = rows[i];
    if (!(mobility_[i] > 0)) row.lower = row.upper = 0;
    if (row.lower >= row.upper) row.state = BoundedRow::kLower;
    guess_[i] = std::min(std::max(row.impulse, row.lower), row.upper);
  }
}

void BoundedRows::solve(double energy) {
  start_.assign(bodies.begin(), bodies.end());
  compute_mobility();
  energy_scale_ = min_energy_scale_ = energy;
  assembled_ = false;
  solve_from_start();
}

void BoundedRows::solve_again() {
  if (descended_) {
    set_fixed();
    start_from(guess_);
    descend();
    prevent_energy_gain(false);
    if (is_infeasible()) relax_infeasible_rows();
    return;
  }
  std::copy(start_.begin(), start_.end(), bodies.begin());
  solve_from_start();
}

void BoundedRows::solve_from_start() {
  descended_ = false;
  set_fixed();
  if (solve_small()) return;
  if (!assembled_) compute_energy_scale(), assemble();
  solve_impulses();
  if (is_infeasible()) relax_infeasible_rows();
}

// Finds the impulses by pivots or, if these do not end, by descent.
void BoundedRows::solve_impulses() {
  const bool solved = pivot();
  if (!solved) {
    descended_ = true;
    start_from(best_);
    scale_impulses();
    descend();
  }
  prevent_energy_gain(solved);
}

// Sets the impulses, within their bounds.
void BoundedRows::start_from(std::span<const double> impulses) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].impulse = std::min(std::max(impulses[i], rows[i].lower), rows[i].upper);
  apply_all();
}

// Ensures that no energy is gained. If all rows are free, none is. A row at its bound may gain its impulse
// times the tolerated violation, and impulses of wedged parts have no limit.
void BoundedRows::prevent_energy_gain(bool exact) {
  const auto held = [](const BoundedRow& row) { return row.state != BoundedRow::kFree && row.impulse != 0; };
  if (!exact || regularised_ || std::any_of(rows.begin(), rows.end(), held)) scale_impulses();
}

double BoundedRows::best_load_fraction(std::span<const double> impulses, double cost) {
  assert(impulses.size() == rows.size());
  const auto work = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) sum += impulses[i] * row_velocity(rows[i]);
    return sum;
  };
  const double on_load = work();
  for (BoundedBody& body : bodies) body.velocity = {}, body.spin = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) apply_impulse(rows[i], impulses[i]);
  const double own = work() + cost;
  if (!(own > 0)) return 1;
  const double fraction = -on_load / own;
  return fraction > 0 ? std::min(fraction, 1.0) : 0;  // 0 after an overflow, which must not last
}

void BoundedRows::correct(double softening) {
  // Maximum number of rounds. Of 76,500 corrections of ragdolls that fall onto a heap, 2,000 take a second
  // round, 102 a third and 5 a fourth.
  constexpr int kRounds = 4;
  compute_mobility();
  for (BoundedRow& row : rows) row.softening = softening;
  assemble();
  bool overrun = true;
  for (int round = 0; overrun && round < kRounds; ++round) {
    factorise();
    solve_displacements();
    overrun = false;
    for (BoundedRow& row : rows) {
      if (row.state == BoundedRow::kFree || !(row.upper > 0)) continue;
      const Displacement &a = displacements[row.a], &b = displacements[row.b];
      const double moved = dot(row.linear_a, a.translation) + row.angular_a * a.rotation +
                           dot(row.linear_b, b.translation) + row.angular_b * b.rotation;
      if (!(row.gap + moved < 0)) continue;
      row.state = BoundedRow::kFree;
      overrun = true;
    }
  }
}

// Finds the displacements that close the gaps of the free rows.
void BoundedRows::solve_displacements() {
  displacements.assign(bodies.size(), {});
  x_.resize(free_.size());
  for (std::size_t k = 0; k < free_.size(); ++k) x_[k] = -rows[free_[k]].gap;  // `correct` removes none
  free_matrix_.solve(x_.data());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const BoundedRow& row = rows[free_[k]];
    const auto add = [&](int body, Vec2d linear, double angular) {
      const BoundedBody& b = bodies[body];
      displacements[body].translation.x += b.inverse_mass.x * linear.x * x_[k];
      displacements[body].translation.y += b.inverse_mass.y * linear.y * x_[k];
      displacements[body].rotation += b.inverse_inertia * angular * x_[k];
    };
    add(row.a, row.linear_a, row.angular_a);
    add(row.b, row.linear_b, row.angular_b);
  }
}

}  // namespace plumb
