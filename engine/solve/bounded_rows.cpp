#include "engine/solve/bounded_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {
namespace {

// Added to the mobility of each row, as a share of it: rows that depend on each other share their load. What
// rows miss for it is taken back by refinement.
constexpr double kSharing = 1e-10;
constexpr int kRefinements = 2;
// Of the largest speed: what rows may miss.
constexpr double kExact = 1e-11;
// Of the largest speed: by how much a row may be on the wrong side.
constexpr double kSlack = 1e-9;
// Block pivots that may pass without fewer rows on the wrong side; and pivots in all.
constexpr int kPatience = 4, kPivots = 60;
// Sweeps of projected Gauss-Seidel after that.
constexpr int kSweeps = 100;

double coupling(const BoundedBody& body, Vec2d linear_r, double angular_r, Vec2d linear_s, double angular_s) {
  return body.inverse_mass.x * linear_r.x * linear_s.x + body.inverse_mass.y * linear_r.y * linear_s.y +
         body.inverse_inertia * angular_r * angular_s;
}

double coupling(std::span<const BoundedBody> bodies, const BoundedRow& r, const BoundedRow& s) {
  double sum = 0;
  if (r.a == s.a) sum += coupling(bodies[r.a], r.linear_a, r.angular_a, s.linear_a, s.angular_a);
  if (r.a == s.b) sum += coupling(bodies[r.a], r.linear_a, r.angular_a, s.linear_b, s.angular_b);
  if (r.b == s.a) sum += coupling(bodies[r.b], r.linear_b, r.angular_b, s.linear_a, s.angular_a);
  if (r.b == s.b) sum += coupling(bodies[r.b], r.linear_b, r.angular_b, s.linear_b, s.angular_b);
  return sum;
}

}  // namespace

BoundedRows::BoundedRows(std::pmr::memory_resource* room)
    : bodies(room),
      rows(room),
      shifts(room),
      order_(room),
      matrix_(room),
      start_(room),
      mobility_(room),
      block_first_(room),
      free_(room),
      place_(room),
      block_place_(room),
      first_(room),
      x_(room),
      best_(room),
      wrong_(room) {}

double BoundedRows::order(std::span<const std::pair<int, int>> blocks, std::span<const int> sizes) {
  std::pmr::vector<std::pair<int, int>> ends(rows.get_allocator());
  const int count = static_cast<int>(blocks.size());
  for (int block = 0; block < count; ++block) {
    if (bodies[blocks[block].first].gives_way()) ends.emplace_back(blocks[block].first, block);
    if (bodies[blocks[block].second].gives_way()) ends.emplace_back(blocks[block].second, block);
  }
  order_.find(count, ends);
  block_place_.assign(count, 0);
  int next = 0;
  for (const int block : order_.sequence()) block_place_[block] = next, next += sizes[block];
  first_.clear();
  for (const int block : order_.sequence()) {
    int first = block_place_[block];
    for (const int other : order_.neighbours(block)) first = std::min(first, block_place_[other]);
    for (int i = 0; i < sizes[block]; ++i) first_.push_back(first);
  }
  return EnvelopeMatrix::cost(first_);
}

double BoundedRows::along(const BoundedRow& row) const {
  const BoundedBody &a = bodies[row.a], &b = bodies[row.b];
  return dot(row.linear_a, a.velocity) + row.angular_a * a.spin + dot(row.linear_b, b.velocity) +
         row.angular_b * b.spin;
}

void BoundedRows::push(const BoundedRow& row, double impulse) {
  if (impulse == 0) return;
  const auto add = [&](BoundedBody& body, Vec2d linear, double angular) {
    body.velocity.x += body.inverse_mass.x * linear.x * impulse;
    body.velocity.y += body.inverse_mass.y * linear.y * impulse;
    body.spin += body.inverse_inertia * angular * impulse;
  };
  add(bodies[row.a], row.linear_a, row.angular_a);
  add(bodies[row.b], row.linear_b, row.angular_b);
}

void BoundedRows::find_mobility() {
  mobility_.resize(rows.size());
  speed_ = 0;
  const int blocks = static_cast<int>(order_.sequence().size());
  block_first_.assign(blocks + 1, 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const BoundedRow& row = rows[i];
    mobility_[i] = coupling(bodies, row, row);
    speed_ = std::max({speed_, std::abs(along(row)), std::abs(row.wanted)});
    block_first_[row.block + 1] = static_cast<int>(i) + 1;
  }
  for (int block = 0; block < blocks; ++block)
    block_first_[block + 1] = std::max(block_first_[block + 1], block_first_[block]);
}

void BoundedRows::factorise() {
  free_.clear();
  place_.assign(rows.size(), -1);
  block_place_.assign(order_.sequence().size(), -1);
  for (const int block : order_.sequence()) {
    block_place_[block] = static_cast<int>(free_.size());
    for (int i = block_first_[block]; i < block_first_[block + 1]; ++i) {
      if (rows[i].state != BoundedRow::kFree) continue;
      place_[i] = static_cast<int>(free_.size());
      free_.push_back(i);
    }
  }
  first_.clear();
  for (const int i : free_) {
    const int block = rows[i].block;
    int first = block_place_[block];
    for (const int other : order_.neighbours(block)) first = std::min(first, block_place_[other]);
    first_.push_back(first);
  }
  matrix_.reset(first_);
  for (int k = 0; k < static_cast<int>(free_.size()); ++k) {
    const int i = free_[k];
    const BoundedRow& row = rows[i];
    const auto couple = [&](int block) {
      for (int j = block_first_[block]; j < block_first_[block + 1]; ++j)
        if (place_[j] >= 0 && place_[j] <= k) matrix_.at(k, place_[j]) = coupling(bodies, row, rows[j]);
    };
    couple(row.block);
    for (const int other : order_.neighbours(row.block)) couple(other);
    if (k > 0 && free_[k - 1] == i - 1 && row.coupled_compliance != 0)
      matrix_.at(k, k - 1) += row.coupled_compliance;
    matrix_.at(k, k) += row.compliance + mobility_[i] * (kSharing + row.softening);
  }
  matrix_.factorise();
}

// What a row misses of what it wants, at the velocities as they are.
double BoundedRows::residual(int i) const {
  const BoundedRow& row = rows[i];
  double missing = row.wanted - along(row) - row.compliance * row.impulse;
  if (row.coupled_compliance != 0) missing -= row.coupled_compliance * rows[i - 1].impulse;
  if (i + 1 < static_cast<int>(rows.size()) && rows[i + 1].coupled_compliance != 0)
    missing -= rows[i + 1].coupled_compliance * rows[i + 1].impulse;
  return missing - row.softening * mobility_[i] * row.impulse;
}

// The bodies' velocities with all impulses as they stand.
void BoundedRows::apply_all() {
  std::copy(start_.begin(), start_.end(), bodies.begin());
  for (const BoundedRow& row : rows) push(row, row.impulse);
}

// Impulses of the free rows for those of the others as they stand.
void BoundedRows::find_free() {
  for (BoundedRow& row : rows) {
    if (row.state == BoundedRow::kFree) {
      row.impulse = 0;
    } else {
      row.impulse = row.state == BoundedRow::kLower ? row.lower : row.upper;
    }
  }
  apply_all();
  x_.resize(free_.size());
  for (int refinement = 0; refinement <= kRefinements; ++refinement) {
    double most = 0;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      x_[k] = residual(free_[k]);
      most = std::max(most, std::abs(x_[k]));
    }
    if (most <= kExact * speed_) break;
    matrix_.solve(x_.data());
    for (std::size_t k = 0; k < free_.size(); ++k) {
      rows[free_[k]].impulse += x_[k];
      push(rows[free_[k]], x_[k]);
    }
  }
}

int BoundedRows::count_wrong() {
  int count = 0;
  wrong_.assign(rows.size(), 0);
  const double slack = kSlack * speed_;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const BoundedRow& row = rows[i];
    int to = -1;
    if (row.state == BoundedRow::kFree) {
      if ((row.lower - row.impulse) * mobility_[i] > slack) to = BoundedRow::kLower;
      if ((row.impulse - row.upper) * mobility_[i] > slack) to = BoundedRow::kUpper;
    } else if (row.lower < row.upper) {
      const double missing = residual(i);
      if (row.state == BoundedRow::kLower && missing > slack) to = BoundedRow::kFree;
      if (row.state == BoundedRow::kUpper && missing < -slack) to = BoundedRow::kFree;
    }
    if (to < 0) continue;
    wrong_[i] = static_cast<std::int8_t>(to + 1);
    ++count;
  }
  return count;
}

void BoundedRows::pivot_all() {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (wrong_[i] != 0) rows[i].state = static_cast<BoundedRow::State>(wrong_[i] - 1);
}

void BoundedRows::pivot_last() {
  for (std::size_t i = rows.size(); i-- > 0;) {
    if (wrong_[i] == 0) continue;
    rows[i].state = static_cast<BoundedRow::State>(wrong_[i] - 1);
    return;
  }
}

// Of what the impulses do, less what was there: 1/2 x (J M^-1 J^T + C) x - x (wanted - J v), which no
// solution may have above 0.
double BoundedRows::energy() const {
  double sum = 0;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const BoundedRow& row = rows[i];
    if (row.impulse == 0) continue;
    const BoundedBody &a = start_[row.a], &b = start_[row.b];
    const double before = dot(row.linear_a, a.velocity) + row.angular_a * a.spin +
                          dot(row.linear_b, b.velocity) + row.angular_b * b.spin;
    sum -= 0.5 * row.impulse * (residual(i) + row.wanted - before);
  }
  return sum;
}

// Each sweep lowers the energy.
void BoundedRows::sweep() {
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].impulse = std::min(std::max(best_[i], rows[i].lower), rows[i].upper);
  apply_all();
  if (energy() > 0) {
    for (BoundedRow& row : rows) row.impulse = std::min(std::max(0.0, row.lower), row.upper);
    apply_all();
  }
  for (int pass = 0; pass < kSweeps; ++pass) {
    for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
      BoundedRow& row = rows[i];
      const double own = mobility_[i] * (1 + row.softening) + row.compliance;
      if (!(own > 0)) continue;
      const double now = std::min(std::max(row.impulse + residual(i) / own, row.lower), row.upper);
      const double change = now - row.impulse;
      row.impulse = now;
      push(row, change);
    }
  }
}

void BoundedRows::solve() {
  start_.assign(bodies.begin(), bodies.end());
  find_mobility();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    BoundedRow& row = rows[i];
    // What moves nothing, and what may not press, has nothing to find.
    if (!(mobility_[i] > 0)) row.lower = row.upper = 0;
    if (row.lower >= row.upper) row.state = BoundedRow::kLower;
  }
  int least = std::numeric_limits<int>::max(), patience = kPatience;
  bool one_by_one = false;
  best_.assign(rows.size(), 0);
  for (int pivot = 0; pivot < kPivots; ++pivot) {
    factorise();
    find_free();
    const int wrong = count_wrong();
    if (wrong < least) {
      least = wrong, patience = kPatience, one_by_one = false;
      for (std::size_t i = 0; i < rows.size(); ++i) best_[i] = rows[i].impulse;
    } else if (--patience <= 0) {
      one_by_one = true;
    }
    if (wrong == 0) return;
    one_by_one ? pivot_last() : pivot_all();
  }
  sweep();
}

void BoundedRows::correct(double softening) {
  find_mobility();
  for (BoundedRow& row : rows) row.softening = softening;
  factorise();
  shifts.assign(bodies.size(), {});
  x_.resize(free_.size());
  for (std::size_t k = 0; k < free_.size(); ++k) x_[k] = -rows[free_[k]].gap;
  matrix_.solve(x_.data());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const BoundedRow& row = rows[free_[k]];
    const auto add = [&](int body, Vec2d linear, double angular) {
      const BoundedBody& b = bodies[body];
      shifts[body].way.x += b.inverse_mass.x * linear.x * x_[k];
      shifts[body].way.y += b.inverse_mass.y * linear.y * x_[k];
      shifts[body].turn += b.inverse_inertia * angular * x_[k];
    };
    add(row.a, row.linear_a, row.angular_a);
    add(row.b, row.linear_b, row.angular_b);
  }
}

}  // namespace plumb
