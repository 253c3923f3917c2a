#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/precise/dynamics/motion.h"

// Closed linkages near kinematic singularities, at which their rows become dependent.
namespace plumb::precise {

/// Returns true if joints close a loop, through the world or not, so that bodies and joints form no forest.
bool EquationsOfMotion::find_loops() const {
  std::vector<int> group(poses_.size() + 1);
  std::iota(group.begin(), group.end(), 0);
  const auto root = [&](int i) {
    while (group[static_cast<std::size_t>(i)] != i) i = group[static_cast<std::size_t>(i)];
    return i;
  };
  const auto node = [&](int body) {
    const bool moves =
        body != kFixedFrame && (joint_inverse_mass_[body] > 0 || joint_inverse_inertia_[body] > 0);
    return moves ? body : static_cast<int>(poses_.size());
  };
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    if (r > 0 && joint_of_row_[r] == joint_of_row_[r - 1]) continue;
    const int a = root(node(rows_[r].a)), b = root(node(rows_[r].b));
    if (a == b) return true;
    group[static_cast<std::size_t>(a)] = b;
  }
  return false;
}

double EquationsOfMotion::min_pivot_ratio_at(double time, std::span<const double> y) {
  update_poses(time, y);
  find_rows(rows_);
  const int dependent = system_.factor(rows_);
  return dependent > system_.frozen_count() ? 0 : system_.min_pivot_ratio();
}

double EquationsOfMotion::newton_step_towards(double time, std::span<const double> target,
                                              std::span<double> y) {
  update_poses(time, y);
  find_rows(rows_);
  system_.factor(rows_);
  std::vector<Twist<double>>& shift = accelerations_;
  std::fill(shift.begin(), shift.end(), Twist<double>{});
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const std::size_t i = kPerBody * slot;
    shift[bodies_[slot]] = {{target[i] - y[i], target[i + 1] - y[i + 1]}, target[i + 2] - y[i + 2]};
  }
  for (std::size_t r = 0; r < rows_.size(); ++r)
    right_side_[r] = -(rows_[r].residual + row_speed(rows_[r], shift));
  solve_joints();
  add_joint_response(shift);
  double moved = 0;
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const Twist<double>& s = shift[bodies_[slot]];
    const double step[3] = {s.velocity.x, s.velocity.y, s.angular_velocity};
    for (std::size_t i = 0; i < 3; ++i) {
      y[kPerBody * slot + i] += step[i];
      moved = std::max(moved, std::abs(step[i]) * (i < 2 ? 1 : length_));
    }
  }
  return moved;
}

void EquationsOfMotion::project_velocities(double time, std::span<double> y) {
  update_poses(time, y);
  find_rows(rows_);
  system_.factor(rows_);
  for (std::size_t r = 0; r < rows_.size(); ++r) right_side_[r] = -row_speed(rows_[r], twists_);
  solve_joints();
  std::vector<Twist<double>>& shift = accelerations_;
  std::fill(shift.begin(), shift.end(), Twist<double>{});
  add_joint_response(shift);
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const Twist<double>& s = shift[bodies_[slot]];
    y[kPerBody * slot + 3] += s.velocity.x;
    y[kPerBody * slot + 4] += s.velocity.y;
    y[kPerBody * slot + 5] += s.angular_velocity;
  }
}

void EquationsOfMotion::project_change(std::span<double> change) {
  std::vector<Twist<double>>& shift = accelerations_;
  for (const std::size_t half : {std::size_t{0}, std::size_t{3}}) {
    std::fill(shift.begin(), shift.end(), Twist<double>{});
    for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
      const double* c = change.data() + kPerBody * slot + half;
      shift[bodies_[slot]] = {{c[0], c[1]}, c[2]};
    }
    for (std::size_t r = 0; r < rows_.size(); ++r) right_side_[r] = -row_speed(rows_[r], shift);
    solve_joints();
    add_joint_response(shift);
    for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
      double* c = change.data() + kPerBody * slot + half;
      const Twist<double>& s = shift[bodies_[slot]];
      c[0] = s.velocity.x, c[1] = s.velocity.y, c[2] = s.angular_velocity;
    }
  }
}

double EquationsOfMotion::remaining_gap(double time, std::span<double> y, double weak) {
  constexpr int kMaxIterations = 8;
  std::vector<Twist<double>>& shift = accelerations_;
  system_.set_pivot_threshold(weak);
  double open = 0;
  for (int i = 0;; ++i) {
    update_poses(time, y);
    find_rows(rows_);
    open = worst_gap().gap;
    if (i == kMaxIterations) break;
    system_.factor(rows_);
    for (std::size_t r = 0; r < rows_.size(); ++r) right_side_[r] = -rows_[r].residual;
    solve_joints();
    std::fill(shift.begin(), shift.end(), Twist<double>{});
    add_joint_response(shift);
    for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
      const Twist<double>& s = shift[bodies_[slot]];
      y[kPerBody * slot] += s.velocity.x;
      y[kPerBody * slot + 1] += s.velocity.y;
      y[kPerBody * slot + 2] += s.angular_velocity;
    }
  }
  system_.set_pivot_threshold(0);
  // Rows that are always redundant must close to the accuracy of `project`, or the linkage could not move.
  constexpr double kOpen = 1e-9;
  return system_.frozen_count() > 0 ? std::max(open - std::min(kOpen, tolerance_) * length_, 0.0) : open;
}

std::string EquationsOfMotion::weakest_joint() const {
  const std::size_t row = system_.min_pivot_row();
  return row < joint_of_row_.size() ? joint_of_row_[row] : std::string();
}

}  // namespace plumb::precise
