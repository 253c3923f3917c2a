#include "engine/world/joint_solver/direct_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {
namespace {

// Regularisation (CFM): added to the diagonal, as a fraction of it, so that redundant rows share their load.
// Redundant supports that are not quite level are wedged with forces of the error of their levels divided by
// this value. Below 3e-5 the impulses of a pyramid therefore change from substep to substep, and its boxes
// shake. Above 1e-2 they yield for several substeps after a load has changed.
constexpr double kRegularisation = 1e-4;
// Mass ratio and number of rows above which the regularisation is reduced: in proportion to the ratio, and to
// the square of the number. The smallest eigenvalues that carry a load are a fraction 1 / (2 ratio) of the
// largest, and in a tower 5 / rows^2.
constexpr double kLargeMassRatio = 100, kManyRows = 96;
// Number of iterative refinements, which remove the error of the rates due to the regularisation, and the
// residual at which they end, as a fraction of the rate due to the load. More refinements would wedge
// redundant rows.
constexpr int kRefinements = 2;
constexpr double kResidualTolerance = 1e-8;
// Rows are infeasible (a body is pushed out of two walls at once) if the last refinement leaves more
// than kStalled of the previous residual, while no impulse falls by more than kMaxDecrease times the largest
// rise: all rows push, and more refinements do not help. Redundant supports that are not level leave a
// residual too, but some of their impulses fall until those rows no longer press.
constexpr double kStalled = 0.5, kMaxDecrease = 0.1;
// Maximum number of steps of block principal pivoting, which exchange active and inactive rows.
constexpr int kMaxPivotSteps = 10;
// Number of steps that may fail to reduce the number of violated rows, before rows are exchanged one at a
// time.
constexpr int kPatience = 3;
// Velocity at which a removed row counts as violated, relative to the largest requested velocity: rounding.
constexpr double kViolationTolerance = 1e-5;
// Returns J_r M^-1 J_s^T: the coupling of two rows through one body that both act on.
template <class Real>
double coupling(const SolverBody<Real>& body, Vec2<Real> linear_r, Real angular_r, Vec2<Real> linear_s,
                Real angular_s) {
  return double(body.inverse_mass) * (double(linear_r.x) * linear_s.x + double(linear_r.y) * linear_s.y) +
         double(body.inverse_inertia) * angular_r * angular_s;
}

template <class Real>
double coupling(const SolverBody<Real>* motion, const DirectRow<Real>& r, const DirectRow<Real>& s) {
  double sum = 0;
  if (r.a == s.a) sum += coupling(motion[r.a], r.linear_a, r.angular_a, s.linear_a, s.angular_a);
  if (r.a == s.b) sum += coupling(motion[r.a], r.linear_a, r.angular_a, s.linear_b, s.angular_b);
  if (r.b == s.a) sum += coupling(motion[r.b], r.linear_b, r.angular_b, s.linear_a, s.angular_a);
  if (r.b == s.b) sum += coupling(motion[r.b], r.linear_b, r.angular_b, s.linear_b, s.angular_b);
  return sum;
}

// Non-dynamic bodies are only read: several islands may stand on one.
template <class Real>
void apply_impulse(SolverBody<Real>& motion, Vec2<Real> impulse, Real angular_impulse) {
  if (is_dynamic(motion)) motion.apply(impulse, angular_impulse);
}

}  // namespace

template <class Real>
double DirectRows<Real>::order(const SolverBody<Real>* motion) {
  // Blocks are neighbours if they act on the same dynamic body.
  const int count = rows.empty() ? 0 : rows.back().block + 1;
  block_first_.assign(count + 1, 0);
  body_blocks_.clear();
  for (int i = static_cast<int>(rows.size()) - 1; i >= 0; --i) block_first_[rows[i].block] = i;
  block_first_[count] = static_cast<int>(rows.size());
  for (int block = 0; block < count; ++block) {
    const DirectRow<Real>& row = rows[block_first_[block]];
    if (is_dynamic(motion[row.a])) body_blocks_.emplace_back(row.a, block);
    if (is_dynamic(motion[row.b])) body_blocks_.emplace_back(row.b, block);
  }
  std::sort(body_blocks_.begin(), body_blocks_.end());
  order_.compute(count, body_blocks_);

  rows_in_order_.clear();
  position_.resize(rows.size());
  for (const int block : order_.sequence()) {
    for (int row = block_first_[block]; row < block_first_[block + 1]; ++row) {
      position_[row] = static_cast<int>(rows_in_order_.size());
      rows_in_order_.push_back(row);
    }
  }
  first_columns_.resize(rows.size());
  for (int i = 0; i < static_cast<int>(rows_in_order_.size()); ++i) {
    const int block = rows[rows_in_order_[i]].block;
    int first = position_[block_first_[block]];
    for (const int other : order_.neighbours(block)) first = std::min(first, position_[block_first_[other]]);
    first_columns_[i] = first;
  }
  return EnvelopeMatrix::cost(first_columns_);
}

template <class Real>
void DirectRows<Real>::set_regularisation(const SolverBody<Real>* motion) {
  Real least = std::numeric_limits<Real>::max(), most = 0;
  for (const DirectRow<Real>& row : rows) {
    for (const int body : {row.a, row.b}) {
      const Real inverse = motion[body].inverse_mass;
      if (inverse > 0) least = std::min(least, inverse), most = std::max(most, inverse);
    }
  }
  const double ratio = most > 0 ? double(most) / double(least) : 1,
               row_ratio = double(rows.size()) / kManyRows;
  regularisation_ =
      kRegularisation / (std::max(1.0, ratio / kLargeMassRatio) * std::max(1.0, row_ratio * row_ratio));
}

template <class Real>
void DirectRows<Real>::assemble(const SolverBody<Real>* motion) {
  set_regularisation(motion);
  biased_.valid = unbiased_.valid = false;
  matrix_.reset(first_columns_);
  diagonal_.resize(first_columns_.size());
  for (int i = 0; i < matrix_.size(); ++i) {
    const DirectRow<Real>& row = rows[rows_in_order_[i]];
    const auto couple = [&](int block) {
      for (int other = block_first_[block]; other < block_first_[block + 1] && position_[other] <= i; ++other)
        matrix_.at(i, position_[other]) = coupling(motion, row, rows[other]);
    };
    couple(row.block);
    for (const int block : order_.neighbours(row.block)) couple(block);
    diagonal_[i] = matrix_.at(i, i);
  }
}

// Factorises the matrix of the active rows. Rows before the index `from` are unchanged.
template <class Real>
void DirectRows<Real>::factorise(Factors& factors, int from) {
  EnvelopeMatrix& matrix = factors.matrix;
  for (int i = from; i < matrix.size(); ++i) {
    const DirectRow<Real>& row = rows[rows_in_order_[i]];
    const bool active = row.active;
    for (int j = first_columns_[i]; j < i; ++j)
      matrix.at(i, j) = active && rows[rows_in_order_[j]].active ? matrix_.at(i, j) : 0;
    matrix.at(i, i) = active ? matrix_.at(i, i) * (1 + regularisation_ + row.softening)
                             : 1;  // 1: no coupling, and no impulse
  }
  matrix.factorise(from);
}

// Removes or restores the violated rows. Returns the index of the first row that changed.
template <class Real>
int DirectRows<Real>::exchange_violated(Factors& factors) {
  int from = factors.matrix.size();
  for (int i = factors.matrix.size() - 1; i >= 0; --i) {
    DirectRow<Real>& row = rows[rows_in_order_[i]];
    if (row.violated) row.active = !row.active, from = i;
  }
  return from;
}

template <class Real>
bool DirectRows<Real>::solve_impulses(SolverBody<Real>* motion, bool use_bias) {
  Factors& factors = use_bias ? biased_ : unbiased_;
  x_.resize(rows.size());
  for (DirectRow<Real>& row : rows) row.removed_impulse = 0;
  if (factors.valid) {
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].active = factors.active[i] != 0;
  } else if (const Factors& other = use_bias ? unbiased_ : biased_; other.valid) {
    factors.matrix = other.matrix;
  } else {
    factors.matrix.reset(first_columns_);
    factorise(factors, 0);
  }
  factors.valid = true;
  factors.active.resize(rows.size());
  remove_inactive(motion);
  bool found = false;
  int min_violated = std::numeric_limits<int>::max(), patience = kPatience;
  for (int step = 0; step < kMaxPivotSteps; ++step) {
    const double max_rate = solve_active(motion, factors.matrix);
    // Remove rows that would pull and restore violated ones, all at once as long as that reduces their
    // number, otherwise only the last one.
    int violated = 0;
    DirectRow<Real>* last = nullptr;
    DirectRow<Real>* const all = rows.data();
    const int* const rows_in_order = rows_in_order_.data();
    const double* const x = x_.data();
    for (int i = 0, count = matrix_.size(); i < count; ++i) {
      DirectRow<Real>& row = all[rows_in_order[i]];
      row.violated = row.unilateral && (row.active ? double(*row.impulse) + x[i] < 0
                                                   : velocity_error(motion, i) + velocity_response(i) <
                                                         -kViolationTolerance * max_rate);
      if (row.violated) ++violated, last = &row;
    }
    found = violated == 0;
    if (found || step + 1 == kMaxPivotSteps) break;
    if (violated < min_violated) {
      min_violated = violated, patience = kPatience;
    } else if (--patience < 0) {
      for (DirectRow<Real>& row : rows) row.violated = &row == last;
    }
    const int from = exchange_violated(factors);
    remove_inactive(motion);
    factorise(factors, from);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) factors.active[i] = rows[i].active;
  if (found && !infeasible_) return true;
  restore_removed(motion);
  return false;
}

// Solves for the impulses x of the active rows. Returns the largest requested rate, m/s.
template <class Real>
double DirectRows<Real>::solve_active(const SolverBody<Real>* motion, const EnvelopeMatrix& matrix) {
  const int count = matrix.size();
  double max_rate = 0, load = 0;
  const DirectRow<Real>* const all = rows.data();
  const int* const rows_in_order = rows_in_order_.data();
  const double* const diagonal = diagonal_.data();
  double* const x = x_.data();
  for (int i = 0; i < count; ++i) {
    const DirectRow<Real>& row = all[rows_in_order[i]];
    x[i] = row.active ? -velocity_error(motion, i) : 0;
    max_rate = std::max(max_rate, std::abs(x[i]));
    load = std::max(load, diagonal[i] * double(*row.impulse));
  }
  matrix.solve(x);
  infeasible_ = false;
  residual_.assign(x_.begin(), x_.end());
  double* const residual = residual_.data();
  double last_residual = max_rate;
  for (int refinement = 0;; ++refinement) {
    // (A + D) x = b leaves b - A x = D x.
    double max_residual = 0, least = 0, most = 0;
    for (int i = 0; i < count; ++i) {
      least = std::min(least, residual[i]), most = std::max(most, residual[i]);
      residual[i] *= regularisation_ * diagonal[i];
      max_residual = std::max(max_residual, std::abs(residual[i]));
    }
    if (max_residual <= kResidualTolerance * std::max(load, max_rate)) break;
    if (refinement == kRefinements) {
      infeasible_ = max_residual > kStalled * last_residual && least > -kMaxDecrease * most;
      break;
    }
    last_residual = max_residual;
    matrix.solve(residual);
    for (int i = 0; i < count; ++i) x[i] += residual[i];
  }
  return max_rate;
}

// Returns the velocity error of a row, m/s: J v + bias.
template <class Real>
double DirectRows<Real>::velocity_error(const SolverBody<Real>* motion, int position) const {
  const DirectRow<Real>& row = rows[rows_in_order_[position]];
  const SolverBody<Real>&a = motion[row.a], &b = motion[row.b];
  const double rate = double(dot(row.linear_a, a.velocity) + row.angular_a * a.angular_velocity +
                             dot(row.linear_b, b.velocity) + row.angular_b * b.angular_velocity + row.bias);
  if (row.softening == 0) return rate;
  return rate + row.softening * diagonal_[position] * double(*row.impulse - row.load);
}

// Returns the velocity that the solution causes along a row, m/s.
template <class Real>
double DirectRows<Real>::velocity_response(int position) const {
  double sum = 0;
  for (int i = first_columns_[position]; i < position; ++i) sum += matrix_.at(position, i) * x_[i];
  for (int i = position + 1; i < matrix_.size(); ++i)
    if (first_columns_[i] <= position) sum += matrix_.at(i, position) * x_[i];
  return sum;
}

// Removes the impulses of inactive rows from the bodies.
template <class Real>
void DirectRows<Real>::remove_inactive(SolverBody<Real>* motion) {
  DirectRow<Real>* const all = rows.data();
  const int* const rows_in_order = rows_in_order_.data();
  for (int i = 0, count = matrix_.size(); i < count; ++i) {
    DirectRow<Real>& row = all[rows_in_order[i]];
    if (row.active || *row.impulse == 0) continue;
    row.removed_impulse = *row.impulse;
    apply_impulse(motion[row.a], -row.removed_impulse * row.linear_a, -row.removed_impulse * row.angular_a);
    apply_impulse(motion[row.b], -row.removed_impulse * row.linear_b, -row.removed_impulse * row.angular_b);
    *row.impulse = 0;
  }
}

// Applies them again, so that rows keep their load if iterations solve them instead.
template <class Real>
void DirectRows<Real>::restore_removed(SolverBody<Real>* motion) {
  for (DirectRow<Real>& row : rows) {
    if (row.removed_impulse == 0) continue;
    apply_impulse(motion[row.a], row.removed_impulse * row.linear_a, row.removed_impulse * row.angular_a);
    apply_impulse(motion[row.b], row.removed_impulse * row.linear_b, row.removed_impulse * row.angular_b);
    *row.impulse += row.removed_impulse;
    row.removed_impulse = 0;
  }
}

// Sums each body's impulses before its velocity is rounded. Between a heavy load and the ground the impulses
// on a light body are large and nearly cancel.
template <class Real>
void DirectRows<Real>::apply(SolverBody<Real>* motion) {
  // Local pointers: the compiler must assume that a write to velocities changes any other pointer.
  DirectRow<Real>* const all = rows.data();
  const double* const x = x_.data();
  const int *const position = position_.data(), *const block_first = block_first_.data();
  const auto* next = body_blocks_.data();
  for (const auto* const last = next + body_blocks_.size(); next != last;) {
    const int body = next->first;
    Vec2d impulse_sum{};
    double angular_sum = 0;
    for (; next != last && next->first == body; ++next) {
      for (int i = block_first[next->second], past = block_first[next->second + 1]; i < past; ++i) {
        const DirectRow<Real>& row = all[i];
        if (!row.active) continue;
        const double impulse = x[position[i]];
        const bool is_a = row.a == body;
        impulse_sum += impulse * (is_a ? row.linear_a : row.linear_b).template as<double>();
        angular_sum += impulse * static_cast<double>(is_a ? row.angular_a : row.angular_b);
      }
    }
    SolverBody<Real>& moving = motion[body];
    if (!is_dynamic(moving)) continue;  // other islands may stand on it too
    moving.velocity = (moving.velocity.template as<double>() + double(moving.inverse_mass) * impulse_sum)
                          .template as<Real>();
    moving.angular_velocity =
        static_cast<Real>(double(moving.angular_velocity) + double(moving.inverse_inertia) * angular_sum);
  }
  for (int i = 0, count = static_cast<int>(rows.size()); i < count; ++i)
    if (all[i].active) *all[i].impulse += static_cast<Real>(x[position[i]]);
}

template class DirectRows<float>;
template class DirectRows<double>;

}  // namespace plumb
