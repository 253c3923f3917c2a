#include "engine/linear_algebra/joint_system.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "engine/linear_algebra/elimination_order.h"

namespace plumb {
namespace {

/// Returns the block of each row: consecutive rows with the same bodies are eliminated together.
template <class Real>
std::vector<int> block_of_each(std::span<const Row<Real>> rows) {
  std::vector<int> block(rows.size());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool same = rows[i].a == rows[i - 1].a && rows[i].b == rows[i - 1].b;
    block[i] = block[i - 1] + (same ? 0 : 1);
  }
  return block;
}

}  // namespace

template <class Real>
JointSystem<Real>::JointSystem(std::span<const Row<Real>> rows, std::span<const Real> inverse_mass,
                               std::span<const Real> inverse_inertia)
    : inverse_mass_(inverse_mass.begin(), inverse_mass.end()),
      inverse_inertia_(inverse_inertia.begin(), inverse_inertia.end()) {
  assert(inverse_mass.size() == inverse_inertia.size());
  assert(std::all_of(rows.begin(), rows.end(), [&](const Row<Real>& row) {
    const int count = static_cast<int>(inverse_mass.size());
    return row.a < count && row.b < count && (row.a == kFixedFrame || row.a >= 0) &&
           (row.b == kFixedFrame || row.b >= 0);
  }));
  const auto moving = [&](int body) {
    return body != kFixedFrame && (inverse_mass_[body] > 0 || inverse_inertia_[body] > 0) ? body : -1;
  };
  const std::vector<int> block = block_of_each(rows);
  std::vector<Link> links(rows.empty() ? 0 : block.back() + 1);
  std::vector<std::vector<int>> rows_of(links.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    links[block[i]] = {moving(rows[i].a), moving(rows[i].b)};
    rows_of[block[i]].push_back(static_cast<int>(i));
  }
  const EliminationOrder order = minimum_degree(links, static_cast<int>(inverse_mass_.size()));

  std::vector<int> place(rows.size());  // place in the elimination order, by the caller's row
  for (const int b : order.sequence) {
    for (const int row : rows_of[b]) {
      place[row] = static_cast<int>(order_.size());
      order_.push_back(row);
    }
  }
  std::vector<std::vector<int>> below(rows.size());  // by place: the rows in its column of L
  for (const int b : order.sequence) {
    for (std::size_t i = 0; i < rows_of[b].size(); ++i) {
      std::vector<int>& column = below[place[rows_of[b][i]]];
      for (std::size_t j = i + 1; j < rows_of[b].size(); ++j) column.push_back(place[rows_of[b][j]]);
      for (const int other : order.below[b]) {
        for (const int row : rows_of[other]) column.push_back(place[row]);
      }
      std::sort(column.begin(), column.end());
    }
  }
  find_pattern(below);
  find_terms(rows, place);
  find_hinges(rows, place);
  inverse_diagonal_.assign(rows.size(), 0);
  work_.assign(rows.size(), 0);
  residual_.assign(rows.size(), 0);
  response_.assign(inverse_mass_.size(), {});
}

template <class Real>
void JointSystem<Real>::find_pattern(const std::vector<std::vector<int>>& below) {
  std::vector<std::vector<int>> left(below.size());
  column_start_.assign(1, 0);
  for (std::size_t j = 0; j < below.size(); ++j) {
    row_of_.insert(row_of_.end(), below[j].begin(), below[j].end());
    column_start_.push_back(row_of_.size());
    for (const int i : below[j]) left[i].push_back(static_cast<int>(j));
  }
  row_start_.assign(1, 0);
  for (const std::vector<int>& row : left) {
    column_of_.insert(column_of_.end(), row.begin(), row.end());
    row_start_.push_back(column_of_.size());
  }
  lower_.assign(row_of_.size(), 0);
  filled_.assign(below.size(), 0);
}

template <class Real>
void JointSystem<Real>::find_terms(std::span<const Row<Real>> rows, const std::vector<int>& place) {
  struct Side {
    int row, begin;
  };
  std::vector<std::vector<Side>> sides_at(inverse_mass_.size());
  const auto each_side = [&](int i, const auto& visit) {
    const int bodies[2] = {rows[i].a, rows[i].b};
    for (int side = 0; side < 2; ++side) {
      const int body = bodies[side];
      if (body == kFixedFrame || (inverse_mass_[body] == 0 && inverse_inertia_[body] == 0)) continue;
      visit(body, Side{i, 6 * i + 3 * side});
    }
  };
  const int n = static_cast<int>(rows.size());
  for (int i = 0; i < n; ++i) {
    each_side(i, [&](int body, Side side) { sides_at[body].push_back(side); });
  }
  term_start_.assign(1, 0);
  for (int k = 0; k < n; ++k) {
    each_side(order_[k], [&](int body, Side side) {
      for (const Side& other : sides_at[body]) {
        if (place[other.row] <= k) terms_.push_back({place[other.row], side.begin, other.begin});
      }
    });
    term_start_.push_back(terms_.size());
  }
  jacobian_.assign(6 * rows.size(), 0);
  weighted_.assign(6 * rows.size(), 0);
}

template <class Real>
void JointSystem<Real>::set_jacobian(std::span<const Row<Real>> rows) {
  const auto put = [&](std::size_t at, int body, Vec2<Real> linear, Real angular) {
    const Real mass = body == kFixedFrame ? 0 : inverse_mass_[body];
    const Real inertia = body == kFixedFrame ? 0 : inverse_inertia_[body];
    jacobian_[at] = linear.x, jacobian_[at + 1] = linear.y, jacobian_[at + 2] = angular;
    weighted_[at] = mass * linear.x, weighted_[at + 1] = mass * linear.y,
    weighted_[at + 2] = inertia * angular;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    put(6 * i, rows[i].a, rows[i].linear_a, rows[i].angular_a);
    put(6 * i + 3, rows[i].b, rows[i].linear_b, rows[i].angular_b);
  }
}

// Factorises up-looking (T. A. Davis, Algorithm 849: a concise sparse Cholesky factorization package, ACM
// TOMS 31, 2005): row k of L from the rows before it,
//     L(0..k-1, 0..k-1) y = A(0..k-1, k),  L(k, j) = y(j) / D(j),  D(k) = A(k, k) - sum of L(k, j) y(j).
template <class Real>
int JointSystem<Real>::factor(std::span<const Row<Real>> rows) {
  assert(rows.size() == row_count());
  min_pivot_ratio_ = 1;
  min_pivot_place_ = order_.size();
  if (!hinges_.empty()) return factor_hinges(rows);
  int dependent = 0;
  set_jacobian(rows);
  std::copy(column_start_.begin(), column_start_.end() - 1, filled_.begin());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    for (std::size_t p = term_start_[k]; p < term_start_[k + 1]; ++p) {
      const Real* m = &weighted_[terms_[p].left];
      const Real* j = &jacobian_[terms_[p].right];
      work_[terms_[p].place] += m[0] * j[0] + m[1] * j[1] + m[2] * j[2];
    }
    const Real diagonal = work_[k];
    work_[k] = 0;
    Real pivot = diagonal;
    for (std::size_t q = row_start_[k]; q < row_start_[k + 1]; ++q) {
      const int j = column_of_[q];
      const Real y = work_[j];
      work_[j] = 0;
      for (std::size_t p = column_start_[j]; p < filled_[j]; ++p) work_[row_of_[p]] -= lower_[p] * y;
      const Real l = y * inverse_diagonal_[j];
      pivot -= l * y;
      assert(filled_[j] < column_start_[j + 1]);
      lower_[filled_[j]++] = l;
    }
    dependent += set_pivot(pivot, diagonal, k) ? 0 : 1;
  }
  return dependent;
}

/// Sets D's entry at `place`. Returns true if its row is independent.
template <class Real>
bool JointSystem<Real>::set_pivot(Real pivot, Real diagonal, std::size_t place) {
  // A pivot that has lost all but a few digits is the rounding error of a dependent row.
  constexpr Real kDependent = (sizeof(Real) == 8 ? 4096 : 64) * std::numeric_limits<Real>::epsilon();
  const bool independent =
      pivot > std::max(kDependent, pivot_threshold_) * diagonal && (frozen_.empty() || frozen_[place] == 0);
  inverse_diagonal_[place] = independent ? 1 / pivot : 0;
  if (independent && pivot < min_pivot_ratio_ * diagonal)
    min_pivot_ratio_ = pivot / diagonal, min_pivot_place_ = place;
  return independent;
}

template <class Real>
void JointSystem<Real>::set_pivot_threshold(Real ratio) {
  assert(ratio >= 0 && ratio < 1);
  pivot_threshold_ = ratio;
}

template <class Real>
void JointSystem<Real>::freeze_dependent() {
  frozen_.assign(order_.size(), 0);
  frozen_count_ = 0;
  for (std::size_t k = 0; k < order_.size(); ++k) {
    frozen_[k] = inverse_diagonal_[k] == 0;
    frozen_count_ += frozen_[k];
  }
}

template <class Real>
std::vector<char> JointSystem<Real>::dependent() const {
  std::vector<char> rows(order_.size(), 0);
  for (std::size_t k = 0; k < order_.size(); ++k) rows[order_[k]] = inverse_diagonal_[k] == 0;
  return rows;
}

template <class Real>
void JointSystem<Real>::solve(std::span<Real> right_side) const {
  const std::size_t n = order_.size();
  assert(right_side.size() == n);
  for (std::size_t k = 0; k < n; ++k) work_[k] = right_side[order_[k]];
  if (!hinges_.empty()) {
    solve_hinges();
    for (std::size_t k = 0; k < n; ++k) right_side[order_[k]] = work_[k], work_[k] = 0;
    return;
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t p = column_start_[j]; p < column_start_[j + 1]; ++p) {
      work_[row_of_[p]] -= lower_[p] * work_[j];
    }
  }
  for (std::size_t k = 0; k < n; ++k) work_[k] *= inverse_diagonal_[k];
  for (std::size_t j = n; j-- > 0;) {
    for (std::size_t p = column_start_[j]; p < column_start_[j + 1]; ++p) {
      work_[j] -= lower_[p] * work_[row_of_[p]];
    }
  }
  for (std::size_t k = 0; k < n; ++k) right_side[order_[k]] = work_[k];
  std::fill(work_.begin(), work_.end(), Real{0});
}

template <class Real>
void JointSystem<Real>::refine(std::span<const Row<Real>> rows, std::span<const Real> right_side,
                               std::span<Real> x) const {
  assert(rows.size() == row_count() && right_side.size() == rows.size() && x.size() == rows.size());
  std::fill(response_.begin(), response_.end(), Twist<Real>{});
  const auto add_impulse = [&](int body, Vec2<Real> linear, Real angular, Real multiplier) {
    if (body == kFixedFrame) return;
    response_[body].velocity += multiplier * linear;
    response_[body].angular_velocity += multiplier * angular;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    add_impulse(rows[i].a, rows[i].linear_a, rows[i].angular_a, x[i]);
    add_impulse(rows[i].b, rows[i].linear_b, rows[i].angular_b, x[i]);
  }
  for (std::size_t body = 0; body < response_.size(); ++body) {
    response_[body].velocity *= inverse_mass_[body];
    response_[body].angular_velocity *= inverse_inertia_[body];
  }
  const auto along = [&](int body, Vec2<Real> linear, Real angular) {
    if (body == kFixedFrame) return Real{0};
    return dot(linear, response_[body].velocity) + angular * response_[body].angular_velocity;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    residual_[i] = right_side[i] - (along(rows[i].a, rows[i].linear_a, rows[i].angular_a) +
                                    along(rows[i].b, rows[i].linear_b, rows[i].angular_b));
  }
  solve(residual_);
  for (std::size_t i = 0; i < rows.size(); ++i) x[i] += residual_[i];
}

template class JointSystem<float>;
template class JointSystem<double>;

}  // namespace plumb
