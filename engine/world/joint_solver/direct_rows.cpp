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
constexpr double kSharing = 1e-4;
// Mass ratio and number of rows above which the regularisation is reduced: in proportion to the ratio, and to
// the square of the number. The smallest eigenvalues that carry a load are a fraction 1 / (2 ratio) of the
// largest, and in a tower 5 / rows^2.
constexpr double kFarApart = 100, kMany = 96;
// Number of iterative refinements, which remove the error of the rates due to the regularisation, and the
// residual at which they end, as a fraction of the rate due to the load. More refinements would wedge
// redundant rows.
constexpr int kRefinements = 2;
constexpr double kExact = 1e-8;
// Rows contradict each other (a body is pushed out of two walls at once) if the last refinement leaves more
// than kStalled of the previous residual, while no impulse falls by more than kPulls times the largest rise:
// all rows press, and more refinements do not help. Redundant supports that are not level leave a residual
// too, but some of their impulses fall until those rows no longer press.
constexpr double kStalled = 0.5, kPulls = 0.1;
// Maximum number of times that rows are removed or come back before giving up.
constexpr int kTries = 10;
// Number of attempts that may fail to reduce the number of wrong rows, before rows are changed one at a time.
constexpr int kPatience = 3;
// Velocity at which a removed row counts as violated, relative to the largest requested velocity: rounding.
constexpr double kEntered = 1e-5;
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
void push(SolverBody<Real>& motion, Vec2<Real> impulse, Real angular_impulse) {
  if (is_dynamic(motion)) motion.apply(impulse, angular_impulse);
}

}  // namespace

template <class Real>
double DirectRows<Real>::order(const SolverBody<Real>* motion) {
  // Blocks are neighbours if they act on the same dynamic body.
  const int count = rows.empty() ? 0 : rows.back().block + 1;
  block_first_.assign(count + 1, 0);
  ends_.clear();
  for (int i = static_cast<int>(rows.size()) - 1; i >= 0; --i) block_first_[rows[i].block] = i;
  block_first_[count] = static_cast<int>(rows.size());
  for (int block = 0; block < count; ++block) {
    const DirectRow<Real>& row = rows[block_first_[block]];
    if (is_dynamic(motion[row.a])) ends_.emplace_back(row.a, block);
    if (is_dynamic(motion[row.b])) ends_.emplace_back(row.b, block);
  }
  std::sort(ends_.begin(), ends_.end());
  order_.find(count, ends_);

  sequence_.clear();
  place_.resize(rows.size());
  for (const int block : order_.sequence()) {
    for (int row = block_first_[block]; row < block_first_[block + 1]; ++row) {
      place_[row] = static_cast<int>(sequence_.size());
      sequence_.push_back(row);
    }
  }
  first_.resize(rows.size());
  for (int i = 0; i < static_cast<int>(sequence_.size()); ++i) {
    const int block = rows[sequence_[i]].block;
    int first = place_[block_first_[block]];
    for (const int other : order_.neighbours(block)) first = std::min(first, place_[block_first_[other]]);
    first_[i] = first;
  }
  return EnvelopeMatrix::cost(first_);
}

template <class Real>
void DirectRows<Real>::note_masses(const SolverBody<Real>* motion) {
  Real least = std::numeric_limits<Real>::max(), most = 0;
  for (const DirectRow<Real>& row : rows) {
    for (const int body : {row.a, row.b}) {
      const Real inverse = motion[body].inverse_mass;
      if (inverse > 0) least = std::min(least, inverse), most = std::max(most, inverse);
    }
  }
  const double ratio = most > 0 ? double(most) / double(least) : 1, many = double(rows.size()) / kMany;
  sharing_ = kSharing / (std::max(1.0, ratio / kFarApart) * std::max(1.0, many * many));
}

template <class Real>
void DirectRows<Real>::assemble(const SolverBody<Real>* motion) {
  note_masses(motion);
  push_.made = relax_.made = false;
  all_.reset(first_);
  diagonal_.resize(first_.size());
  for (int i = 0; i < all_.size(); ++i) {
    const DirectRow<Real>& row = rows[sequence_[i]];
    const auto couple = [&](int block) {
      for (int other = block_first_[block]; other < block_first_[block + 1] && place_[other] <= i; ++other)
        all_.at(i, place_[other]) = coupling(motion, row, rows[other]);
    };
    couple(row.block);
    for (const int block : order_.neighbours(row.block)) couple(block);
    diagonal_[i] = all_.at(i, i);
  }
}

// Factorises the matrix of the active rows. Rows before the index `from` are unchanged.
template <class Real>
void DirectRows<Real>::factorise(Factors& factors, int from) {
  EnvelopeMatrix& matrix = factors.matrix;
  for (int i = from; i < matrix.size(); ++i) {
    const bool active = rows[sequence_[i]].active;
    for (int j = first_[i]; j < i; ++j)
      matrix.at(i, j) = active && rows[sequence_[j]].active ? all_.at(i, j) : 0;
    matrix.at(i, i) = active ? all_.at(i, i) * (1 + sharing_) : 1;  // 1: no coupling, and no impulse
  }
  matrix.factorise(from);
}

// Removes or restores the rows on the wrong side. Returns the index of the first row that changed.
template <class Real>
int DirectRows<Real>::change_sides(Factors& factors) {
  int from = factors.matrix.size();
  for (int i = factors.matrix.size() - 1; i >= 0; --i) {
    DirectRow<Real>& row = rows[sequence_[i]];
    if (row.wrong) row.active = !row.active, from = i;
  }
  return from;
}

template <class Real>
bool DirectRows<Real>::find(SolverBody<Real>* motion, bool push) {
  Factors& factors = push ? push_ : relax_;
  x_.resize(rows.size());
  for (DirectRow<Real>& row : rows) row.taken = 0;
  if (factors.made) {
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].active = factors.active[i] != 0;
  } else if (const Factors& other = push ? relax_ : push_; other.made) {
    factors.matrix = other.matrix;
  } else {
    factors.matrix.reset(first_);
    factorise(factors, 0);
  }
  factors.made = true;
  factors.active.resize(rows.size());
  take_back(motion);
  bool found = false;
  int fewest = std::numeric_limits<int>::max(), patience = kPatience;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const double asked = solve(motion, factors.matrix);
    // Remove rows that would pull and restore violated ones, all at once as long as that reduces their
    // number, otherwise only the last one.
    int wrong = 0;
    DirectRow<Real>* last = nullptr;
    DirectRow<Real>* const all = rows.data();
    const int* const sequence = sequence_.data();
    const double* const x = x_.data();
    for (int i = 0, count = all_.size(); i < count; ++i) {
      DirectRow<Real>& row = all[sequence[i]];
      row.wrong = row.one_sided && (row.active ? double(*row.impulse) + x[i] < 0
                                               : rate_of(motion, row) + response_of(i) < -kEntered * asked);
      if (row.wrong) ++wrong, last = &row;
    }
    found = wrong == 0;
    if (found || attempt + 1 == kTries) break;
    if (wrong < fewest) {
      fewest = wrong, patience = kPatience;
    } else if (--patience < 0) {
      for (DirectRow<Real>& row : rows) row.wrong = &row == last;
    }
    const int from = change_sides(factors);
    take_back(motion);
    factorise(factors, from);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) factors.active[i] = rows[i].active;
  if (found && !contradicted_) return true;
  give_back(motion);
  return false;
}

// Solves for the impulses x of the active rows. Returns the largest requested rate, m/s.
template <class Real>
double DirectRows<Real>::solve(const SolverBody<Real>* motion, const EnvelopeMatrix& matrix) {
  const int count = matrix.size();
  double asked = 0, load = 0;
  const DirectRow<Real>* const all = rows.data();
  const int* const sequence = sequence_.data();
  const double* const diagonal = diagonal_.data();
  double* const x = x_.data();
  for (int i = 0; i < count; ++i) {
    const DirectRow<Real>& row = all[sequence[i]];
    x[i] = row.active ? -rate_of(motion, row) : 0;
    asked = std::max(asked, std::abs(x[i]));
    load = std::max(load, diagonal[i] * double(*row.impulse));
  }
  matrix.solve(x);
  contradicted_ = false;
  rest_.assign(x_.begin(), x_.end());
  double* const rests = rest_.data();
  double before = asked;
  for (int refinement = 0;; ++refinement) {
    // (A + D) x = b leaves b - A x = D x.
    double rest = 0, least = 0, most = 0;
    for (int i = 0; i < count; ++i) {
      least = std::min(least, rests[i]), most = std::max(most, rests[i]);
      rests[i] *= sharing_ * diagonal[i];
      rest = std::max(rest, std::abs(rests[i]));
    }
    if (rest <= kExact * std::max(load, asked)) break;
    if (refinement == kRefinements) {
      contradicted_ = rest > kStalled * before && least > -kPulls * most;
      break;
    }
    before = rest;
    matrix.solve(rests);
    for (int i = 0; i < count; ++i) x[i] += rests[i];
  }
  return asked;
}

// Returns the velocity error of a row, m/s: J v + bias.
template <class Real>
double DirectRows<Real>::rate_of(const SolverBody<Real>* motion, const DirectRow<Real>& row) const {
  const SolverBody<Real>&a = motion[row.a], &b = motion[row.b];
  return double(dot(row.linear_a, a.velocity) + row.angular_a * a.angular_velocity +
                dot(row.linear_b, b.velocity) + row.angular_b * b.angular_velocity + row.bias);
}

// Returns the velocity that the solution causes along a row, m/s.
template <class Real>
double DirectRows<Real>::response_of(int place) const {
  double sum = 0;
  for (int i = first_[place]; i < place; ++i) sum += all_.at(place, i) * x_[i];
  for (int i = place + 1; i < all_.size(); ++i)
    if (first_[i] <= place) sum += all_.at(i, place) * x_[i];
  return sum;
}

// Removes the impulses of inactive rows from the bodies.
template <class Real>
void DirectRows<Real>::take_back(SolverBody<Real>* motion) {
  DirectRow<Real>* const all = rows.data();
  const int* const sequence = sequence_.data();
  for (int i = 0, count = all_.size(); i < count; ++i) {
    DirectRow<Real>& row = all[sequence[i]];
    if (row.active || *row.impulse == 0) continue;
    row.taken = *row.impulse;
    push(motion[row.a], -row.taken * row.linear_a, -row.taken * row.angular_a);
    push(motion[row.b], -row.taken * row.linear_b, -row.taken * row.angular_b);
    *row.impulse = 0;
  }
}

// Applies them again, so that rows keep their load if iterations solve them instead.
template <class Real>
void DirectRows<Real>::give_back(SolverBody<Real>* motion) {
  for (DirectRow<Real>& row : rows) {
    if (row.taken == 0) continue;
    push(motion[row.a], row.taken * row.linear_a, row.taken * row.angular_a);
    push(motion[row.b], row.taken * row.linear_b, row.taken * row.angular_b);
    *row.impulse += row.taken;
    row.taken = 0;
  }
}

// Sums each body's impulses before its velocity is rounded. Between a heavy load and the ground the impulses
// on a light body are large and nearly cancel.
template <class Real>
void DirectRows<Real>::apply(SolverBody<Real>* motion) {
  // Local pointers: the compiler must assume that a write to velocities changes any other pointer.
  DirectRow<Real>* const all = rows.data();
  const double* const x = x_.data();
  const int *const place = place_.data(), *const block_first = block_first_.data();
  const auto* end = ends_.data();
  for (const auto* const last = end + ends_.size(); end != last;) {
    const int body = end->first;
    Vec2d push{};
    double turning = 0;
    for (; end != last && end->first == body; ++end) {
      for (int i = block_first[end->second], past = block_first[end->second + 1]; i < past; ++i) {
        const DirectRow<Real>& row = all[i];
        if (!row.active) continue;
        const double impulse = x[place[i]];
        const bool is_a = row.a == body;
        push += impulse * (is_a ? row.linear_a : row.linear_b).template as<double>();
        turning += impulse * static_cast<double>(is_a ? row.angular_a : row.angular_b);
      }
    }
    SolverBody<Real>& moving = motion[body];
    if (!is_dynamic(moving)) continue;  // other islands may stand on it too
    moving.velocity =
        (moving.velocity.template as<double>() + double(moving.inverse_mass) * push).template as<Real>();
    moving.angular_velocity =
        static_cast<Real>(double(moving.angular_velocity) + double(moving.inverse_inertia) * turning);
  }
  for (int i = 0, count = static_cast<int>(rows.size()); i < count; ++i)
    if (all[i].active) *all[i].impulse += static_cast<Real>(x[place[i]]);
}

template class DirectRows<float>;
template class DirectRows<double>;

}  // namespace plumb
