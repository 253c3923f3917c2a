#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/text.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/scene/error.h"

// Projects states back onto joints and contacts after steps.
namespace plumb::precise {

void EquationsOfMotion::project(double time, Compensated& y) {
  set_prescribed(time, y);
  if (!has_joints_ && !has_active_constraints()) return;
  if (uses_hinge_system() && hinges_.is_rooted()) return forward_kinematics(time, y);
  close_gaps(time, y);
  // Apply v += M^-1 J^T lambda with A lambda = -J v, at the corrected positions.
  std::vector<Twist<double>>& shift = accelerations_;
  std::fill(shift.begin(), shift.end(), Twist<double>{});
  if (uses_hinge_system()) {
    hinges_.stop_velocities(twists_, shift);
  } else if (has_joints_) {
    system_.factor(rows_);
    for (std::size_t r = 0; r < rows_.size(); ++r) right_side_[r] = -row_speed(rows_[r], twists_);
    solve_joints();
    add_joint_response(shift);
  }
  if (has_active_constraints()) {
    linearise_contacts(false);
    close_contacts(twists_, false, shift);
  }
  if (has_loops_ && allowed_gap_ == 0) check_speeds(shift);
  add_velocities(shift, 1, y);
}

/// Throws `Error` (Run) if velocities, with `shift` added, open a joint by more than the tolerance allows: no
/// shift is valid at a singularity of closed loops.
void EquationsOfMotion::check_speeds(std::span<const Twist<double>> shift) const {
  double fastest = speed_, worst = 0;
  std::size_t joint = 0;
  for (const std::size_t body : bodies_)
    fastest = std::max(fastest, std::sqrt(length_squared(twists_[body].velocity)));
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const double opens = std::abs(row_speed(rows_[r], twists_) + row_speed(rows_[r], shift));
    if (!(opens <= worst)) worst = opens, joint = r;
  }
  if (worst <= std::max(tolerance_, 1e-13) * fastest) return;
  throw Error(Error::Kind::Run, "joint '" + joint_of_row_[joint] + "'", "speed", shortest(worst) + " m/s",
              "its bodies move against each other by more than tolerance " + shortest(tolerance_) +
                  " allows, and no push of the joints ends that: what they ask for contradicts itself here");
}

bool EquationsOfMotion::constraints_do_work() const {
  const auto moves = [&](std::size_t body) {
    return twists_[body].velocity != Vec2d{} || twists_[body].angular_velocity != 0;
  };
  const auto slides = [](const ActiveContact& patch) { return patch.slides(); };
  bool driven = false;
  for (std::size_t k = 0; k < limit_motor_modes_.size(); ++k) {
    const GeneralJoints::LimitOrMotor& limit_motor = general_joints_.limits_and_motors()[k];
    driven = driven || (limit_motor_modes_[k] == LimitMotorMode::Held && limit_motor.role == RowRole::Motor &&
                        (limit_motor.speed != 0 || limit_motor.drive));
  }
  return driven || !prescribed_.empty() ||
         std::any_of(ballistic_bodies_.begin(), ballistic_bodies_.end(), moves) ||
         std::any_of(patches_.begin(), patches_.end(), slides);
}

void EquationsOfMotion::apply_hinge_impulses(double time, Compensated& y) {
  // Fraction of the largest velocity below which an error counts as rounding: the velocities already fit.
  constexpr double kRounding = 1e-12;
  if (uses_hinge_system() ? !hinges_.is_rooted() : has_active_constraints() || !has_hinges_only()) return;
  update_poses(time, y.value());
  std::vector<Twist<double>>& shift = accelerations_;
  std::fill(shift.begin(), shift.end(), Twist<double>{});
  if (uses_hinge_system()) {
    hinges_.update(poses_);
    hinges_.stop_velocities(twists_, shift);
  } else {
    find_rows(rows_);
    system_.factor(rows_);
    for (std::size_t r = 0; r < rows_.size(); ++r) right_side_[r] = -row_speed(rows_[r], twists_);
    solve_joints();
    add_joint_response(shift);
  }
  const auto fastest = [&](const std::vector<Twist<double>>& twists) {
    double most = 0;
    for (const Twist<double>& twist : twists)
      most = std::max(
          {most, std::sqrt(length_squared(twist.velocity)), std::abs(twist.angular_velocity) * length_});
    return most;
  };
  if (fastest(shift) > kRounding * fastest(twists_)) add_velocities(shift, 1, y);
}

/// Sets positions and velocities of bodies that hang by hinges on static ones from their angles.
void EquationsOfMotion::forward_kinematics(double time, Compensated& y) {
  update_poses(time, y.value());
  hinges_.update(poses_);
  hinges_.forward_kinematics(poses_, twists_, [&](std::size_t body) {
    const std::size_t first = kPerBody * static_cast<std::size_t>(slot_[body]);
    y.set(first, poses_[body].position.x);
    y.set(first + 1, poses_[body].position.y);
    y.set(first + 3, twists_[body].velocity.x);
    y.set(first + 4, twists_[body].velocity.y);
  });
}

/// Closes the gaps by Newton's method, q += M^-1 J^T lambda with A lambda = -C, to rounding.
void EquationsOfMotion::close_gaps(double time, Compensated& y) {
  constexpr int kMaxIterations = 20;
  constexpr double kOpen = 1e-9;  // fraction of the scene's length: a larger gap is not due to rounding
  // Newton's method may end with gaps of up to this many rounding errors.
  constexpr double kRoundings = 100;
  std::vector<Twist<double>>& shift = accelerations_;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0;; ++i) {
    update_poses(time, y.value());
    if (uses_hinge_system()) {
      hinges_.update(poses_);
    } else if (has_joints_) {
      find_rows(rows_);
    }
    if (held_limit_motors_ > 0) limit_motor_rows();
    const WorstGap worst = worst_gap();
    const bool stuck = worst.gap > 0.5 * before || i == kMaxIterations;
    const double rounding = rounding_of_gaps();
    const double open =
        std::max({std::min(kOpen, tolerance_) * length_, kRoundings * rounding, allowed_gap_});
    if (worst.gap <= rounding || (stuck && worst.gap <= open)) return;
    if (i == kMaxIterations || !std::isfinite(worst.gap)) {
      throw Error(Error::Kind::Run, worst.subject, "gap", shortest(worst.gap) + " m",
                  "cannot be closed: check the anchors, lengths and positions of the bodies that it joins");
    }
    before = worst.gap;
    std::fill(shift.begin(), shift.end(), Twist<double>{});
    if (uses_hinge_system()) {
      hinges_.close_gaps(poses_, shift);
    } else if (has_joints_) {
      system_.factor(rows_);
      for (std::size_t r = 0; r < rows_.size(); ++r) right_side_[r] = -rows_[r].residual;
      solve_joints();
      add_joint_response(shift);
    }
    if (has_active_constraints()) {
      linearise_contacts(false);
      close_contacts(twists_, true, shift);
    }
    add_displacement(shift, y);
  }
}

void EquationsOfMotion::add_displacement(std::span<const Twist<double>> shift, Compensated& y) const {
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const Twist<double>& s = shift[bodies_[slot]];
    y.add(kPerBody * slot, s.velocity.x);
    y.add(kPerBody * slot + 1, s.velocity.y);
    y.add(kPerBody * slot + 2, s.angular_velocity);
  }
}

/// Returns the widest gap of a joint or a persistent contact at the bodies' poses, m. An angle counts as the
/// displacement at a lever arm of the scene's length.
EquationsOfMotion::WorstGap EquationsOfMotion::worst_gap() const {
  WorstGap worst;
  const auto offer = [&](double gap, const auto& subject) {
    if (std::abs(gap) <= worst.gap) return;
    worst.gap = std::abs(gap);
    worst.subject = subject();
  };
  if (uses_hinge_system()) {
    const HingeSystem::LargestGap widest = hinges_.largest_gap(poses_);
    offer(widest.gap, [&] { return "joint '" + joint_of_row_[2 * widest.hinge] + "'"; });
  } else {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Row<double>& row = rows_[r];
      const bool of_angles = row.linear_a == Vec2d{} && row.linear_b == Vec2d{};
      offer(of_angles ? length_ * row.residual : row.residual,
            [&] { return "joint '" + joint_of_row_[r] + "'"; });
    }
  }
  for (std::size_t k = 0, n = held_limit_motors_ > 0 ? limit_motor_modes_.size() : 0; k < n; ++k) {
    const GeneralJoints::LimitOrMotor& limit_motor = general_joints_.limits_and_motors()[k];
    if (limit_motor_modes_[k] != LimitMotorMode::Held || limit_motor.role != RowRole::Limit) continue;
    offer(limit_motor_rows_[k].residual, [&] { return "joint '" + limit_motor.joint + "'"; });
  }
  for (const ActiveContact& patch : patches_) {
    for (int i = 0; i < patch.count; ++i) {
      const Gap gap =
          gap_of(patch.features[i], *patch.a, poses_[patch.a->body], *patch.b, poses_[patch.b->body]);
      offer(gap.value,
            [&] { return "contact of '" + names_[patch.a->body] + "' and '" + names_[patch.b->body] + "'"; });
    }
  }
  return worst;
}

/// Returns the least possible gap: gaps are differences of positions, so this is the rounding of those.
double EquationsOfMotion::rounding_of_gaps() const {
  double extent = length_;
  for (const std::size_t body : bodies_) {
    extent = std::max({extent, std::abs(poses_[body].position.x), std::abs(poses_[body].position.y)});
  }
  return 4 * std::numeric_limits<double>::epsilon() * extent;
}

}  // namespace plumb::precise
