#include <utility>
#include <vector>

#include "engine/linear_algebra/joint_system.h"

// Chains of hinges are the most common mechanism: this factorises them by blocks of 2 x 2, without indirect
// lookups. Each number comes from the same operations in the same order as in the general version.
namespace plumb {
namespace {

/// The contribution of one body to a row, and the body.
template <class Real>
struct Side {
  int body;
  Vec2<Real> linear;
  Real angular;
};

template <class Real>
Side<Real> side_of(const Row<Real>& row, int side) {
  return side == 0 ? Side<Real>{row.a, row.linear_a, row.angular_a}
                   : Side<Real>{row.b, row.linear_b, row.angular_b};
}

}  // namespace

template <class Real>
void JointSystem<Real>::find_hinges(std::span<const Row<Real>> rows, const std::vector<int>& place) {
  const std::size_t n = rows.size();
  const auto moves = [&](int body) {
    return body != kFixedFrame && (inverse_mass_[body] > 0 || inverse_inertia_[body] > 0);
  };
  if (n % 2 != 0) return;
  std::vector<Hinge> hinges(n / 2);
  for (std::size_t i = 0; i < n; i += 2) {
    const bool pair = rows[i].a == rows[i + 1].a && rows[i].b == rows[i + 1].b;
    const bool alone = (i == 0 || rows[i].a != rows[i - 1].a || rows[i].b != rows[i - 1].b) &&
                       (i + 2 == n || rows[i].a != rows[i + 2].a || rows[i].b != rows[i + 2].b);
    if (!pair || !alone || place[i] % 2 != 0 || place[i + 1] != place[i] + 1) return;
    hinges[static_cast<std::size_t>(place[i] / 2)] = {static_cast<int>(i), place[i]};
  }
  for (Hinge& hinge : hinges) {
    const std::size_t column = static_cast<std::size_t>(hinge.place) + 1, below = column_start_[column];
    const std::size_t count = column_start_[column + 1] - below;
    if (count == 0) continue;
    if (count != 2 || row_of_[below] % 2 != 0) return;
    hinge.next = row_of_[below] / 2;
    const Row<Real>&own = rows[hinge.row], &other = rows[hinges[hinge.next].row];
    int shared = 0;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        if (side_of(own, i).body != side_of(other, j).body || !moves(side_of(own, i).body)) continue;
        hinge.side = i, hinge.next_side = j;
        ++shared;
      }
    }
    if (shared != 1) return;
  }
  hinges_ = std::move(hinges);
  hinge_blocks_.resize(hinges_.size());
}

template <class Real>
std::vector<HingePlace> JointSystem<Real>::hinges() const {
  std::vector<HingePlace> places;
  for (const Hinge& hinge : hinges_)
    places.push_back({hinge.row / 2, hinge.next, hinge.side, hinge.next_side});
  return places;
}

template <class Real>
typename JointSystem<Real>::HingeBlock JointSystem<Real>::hinge_block(const Row<Real>& first,
                                                                      const Row<Real>& second) const {
  HingeBlock block;
  for (int side = 0; side < 2; ++side) {
    const Side<Real> one = side_of(first, side), two = side_of(second, side);
    if (one.body == kFixedFrame) continue;
    const Real mass = inverse_mass_[one.body], inertia = inverse_inertia_[one.body];
    const Vec2<Real> weighted_linear = mass * two.linear;
    const Real weighted_angular = inertia * two.angular;
    block.reduced[0] += mass * one.linear.x * one.linear.x + mass * one.linear.y * one.linear.y +
                        inertia * one.angular * one.angular;
    block.reduced[1] +=
        weighted_linear.x * one.linear.x + weighted_linear.y * one.linear.y + weighted_angular * one.angular;
    block.reduced[2] +=
        weighted_linear.x * two.linear.x + weighted_linear.y * two.linear.y + weighted_angular * two.angular;
  }
  block.diagonal[0] = block.reduced[0], block.diagonal[1] = block.reduced[2];
  return block;
}

template <class Real>
int JointSystem<Real>::factor_hinges(std::span<const Row<Real>> rows) {
  int dependent = 0;
  for (std::size_t h = 0; h < hinges_.size(); ++h) {
    hinge_blocks_[h] = hinge_block(rows[hinges_[h].row], rows[hinges_[h].row + 1]);
  }
  for (std::size_t h = 0; h < hinges_.size(); ++h) {
    const Hinge& hinge = hinges_[h];
    const HingeBlock& block = hinge_blocks_[h];
    const auto place = static_cast<std::size_t>(hinge.place);
    dependent += set_pivot(block.reduced[0], block.diagonal[0], place) ? 0 : 1;
    const Real inverse1 = inverse_diagonal_[place], within = block.reduced[1] * inverse1;
    dependent +=
        set_pivot(block.reduced[2] - within * block.reduced[1], block.diagonal[1], place + 1) ? 0 : 1;
    const Real inverse2 = inverse_diagonal_[place + 1];
    Real* first = lower_.data() + column_start_[place];
    first[0] = within;
    if (hinge.next < 0) continue;
    const Hinge& next = hinges_[hinge.next];
    const Side<Real> left1 = side_of(rows[hinge.row], hinge.side),
                     left2 = side_of(rows[hinge.row + 1], hinge.side);
    const Real mass = inverse_mass_[left1.body], inertia = inverse_inertia_[left1.body];
    HingeBlock& below = hinge_blocks_[hinge.next];
    Real y[2][2], l[2][2];
    for (int i = 0; i < 2; ++i) {
      const Side<Real> row = side_of(rows[next.row + i], hinge.next_side);
      const Vec2<Real> weighted_linear = mass * row.linear;
      const Real weighted_angular = inertia * row.angular;
      y[i][0] = weighted_linear.x * left1.linear.x + weighted_linear.y * left1.linear.y +
                weighted_angular * left1.angular;
      y[i][1] = weighted_linear.x * left2.linear.x + weighted_linear.y * left2.linear.y +
                weighted_angular * left2.angular - within * y[i][0];
      l[i][0] = y[i][0] * inverse1;
      l[i][1] = y[i][1] * inverse2;
    }
    for (int c = 0; c < 2; ++c) {
      below.reduced[0] -= l[0][c] * y[0][c];
      below.reduced[1] -= l[0][c] * y[1][c];
      below.reduced[2] -= l[1][c] * y[1][c];
    }
    first[1] = l[0][0], first[2] = l[1][0];
    Real* second = lower_.data() + column_start_[place + 1];
    second[0] = l[0][1], second[1] = l[1][1];
  }
  return dependent;
}

/// Solves L D L^T x = work_, in place.
template <class Real>
void JointSystem<Real>::solve_hinges() const {
  for (const Hinge& hinge : hinges_) {
    const auto place = static_cast<std::size_t>(hinge.place);
    const Real* l = lower_.data() + column_start_[place];
    Real* x = work_.data() + place;
    x[1] -= l[0] * x[0];
    if (hinge.next >= 0) {  // the two columns are consecutive
      Real* y = work_.data() + hinges_[hinge.next].place;
      y[0] -= l[1] * x[0], y[1] -= l[2] * x[0];
      y[0] -= l[3] * x[1], y[1] -= l[4] * x[1];
    }
  }
  for (std::size_t k = 0; k < work_.size(); ++k) work_[k] *= inverse_diagonal_[k];
  for (std::size_t h = hinges_.size(); h-- > 0;) {
    const Hinge& hinge = hinges_[h];
    const auto place = static_cast<std::size_t>(hinge.place);
    const Real* l = lower_.data() + column_start_[place];
    Real* x = work_.data() + place;
    if (hinge.next < 0) {
      x[0] -= l[0] * x[1];
      continue;
    }
    const Real* y = work_.data() + hinges_[hinge.next].place;
    x[1] -= l[3] * y[0], x[1] -= l[4] * y[1];
    x[0] -= l[0] * x[1], x[0] -= l[1] * y[0], x[0] -= l[2] * y[1];
  }
}

template class JointSystem<float>;
template class JointSystem<double>;

}  // namespace plumb
