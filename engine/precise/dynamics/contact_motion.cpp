#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/math/trigonometry.h"
#include "engine/precise/dynamics/motion.h"

// Equations of motion with persistent contacts. Joints are eliminated first, by their sparse system: R, the
// response of a contact's row, is M^-1 J^T plus the joints' reaction to it. The remaining system is small and
// dense,
//   C a + c = 0,   a = a0 + sum lambda_k R_k,   (C R) lambda = -(C a0 + c),
// with a0 the accelerations without contacts, C the normals and the tangents of sticking contacts. Friction
// of slipping contacts is tied to their normal force: R is the response of n - s mu t.
namespace plumb::precise {
namespace {

Row<double> sum(const Row<double>& a, double factor, const Row<double>& b) {
  Row<double> r = a;
  r.linear_a += factor * b.linear_a, r.linear_b += factor * b.linear_b;
  r.angular_a += factor * b.angular_a, r.angular_b += factor * b.angular_b;
  return r;
}

}  // namespace

void EquationsOfMotion::set_contacts(std::vector<ActiveContact> patches) {
  assert(std::all_of(patches.begin(), patches.end(), [](const ActiveContact& patch) {
    return patch.a != nullptr && patch.b != nullptr && patch.count >= 1 && patch.count <= 2 &&
           std::abs(patch.mode) <= 1;
  }));
  patches_ = std::move(patches);
  for (const ActiveContact& patch : patches_) {
    for (const std::size_t body : {patch.a->body, patch.b->body}) {
      if (ballistic_.contains(body)) ballistic_bodies_.push_back(body);
    }
  }
  std::sort(ballistic_bodies_.begin(), ballistic_bodies_.end());
  ballistic_bodies_.erase(std::unique(ballistic_bodies_.begin(), ballistic_bodies_.end()),
                          ballistic_bodies_.end());
}

/// Computes the responses of rows, at the poses of the last `held` and with the joints' last factorisation.
void EquationsOfMotion::find_response(std::vector<Row<double>> rows, ContactResponse& out) {
  out.rows = std::move(rows);
  const std::size_t bodies = poses_.size();
  out.of_a.resize(out.rows.size());
  out.of_b.resize(out.rows.size());
  out.all.assign(has_joints_ ? out.rows.size() * bodies : 0, {});
  const auto own = [&](int body, Vec2d linear, double angular) -> Twist<double> {
    if (body == kFixedFrame) return {};
    return {inverse_mass_[body] * linear, inverse_inertia_[body] * angular};
  };
  for (std::size_t k = 0; k < out.rows.size(); ++k) {
    const Row<double>& row = out.rows[k];
    out.of_a[k] = own(row.a, row.linear_a, row.angular_a);
    out.of_b[k] = own(row.b, row.linear_b, row.angular_b);
    if (!has_joints_) continue;
    const std::span<Twist<double>> all(out.all.data() + k * bodies, bodies);
    if (row.a != kFixedFrame) all[row.a] = out.of_a[k];
    if (row.b != kFixedFrame) all[row.b] = out.of_b[k];
    // The joints' reaction keeps the anchors' velocities: J dv = 0.
    for (std::size_t r = 0; r < rows_.size(); ++r) right_side_[r] = -row_speed(rows_[r], all);
    solve_joints();
    add_joint_response(all);
  }
}

double EquationsOfMotion::row_response(const Row<double>& row, const ContactResponse& response,
                                       std::size_t k) const {
  const Twist<double> a = response.at(k, row.a, poses_.size()), b = response.at(k, row.b, poses_.size());
  return dot(row.linear_a, a.velocity) + row.angular_a * a.angular_velocity + dot(row.linear_b, b.velocity) +
         row.angular_b * b.angular_velocity;
}

/// Computes the rates of the rows, row after row, by a unit of each response.
void EquationsOfMotion::response_matrix(std::span<const Row<double>> rows, const ContactResponse& response,
                                        std::vector<double>& matrix) const {
  const std::size_t n = response.rows.size();
  matrix.assign(rows.size() * n, 0.0);
  if (has_joints_) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t k = 0; k < n; ++k) matrix[i * n + k] = row_response(rows[i], response, k);
    return;
  }
  // Without joints, a row is affected only by responses on its own bodies.
  std::vector<std::vector<std::size_t>> acting_on(poses_.size());
  for (std::size_t k = 0; k < n; ++k) {
    for (const int body : {response.rows[k].a, response.rows[k].b})
      if (body != kFixedFrame) acting_on[static_cast<std::size_t>(body)].push_back(k);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const int body : {rows[i].a, rows[i].b}) {
      if (body == kFixedFrame) continue;
      for (const std::size_t k : acting_on[static_cast<std::size_t>(body)])
        matrix[i * n + k] = row_response(rows[i], response, k);
    }
  }
}

void EquationsOfMotion::add_response(const ContactResponse& response, std::span<const double> impulses,
                                     std::span<Twist<double>> motion) const {
  for (std::size_t k = 0; k < response.rows.size(); ++k) {
    if (impulses[k] == 0) continue;
    const auto add = [&](std::size_t body, const Twist<double>& change) {
      motion[body].velocity += impulses[k] * change.velocity;
      motion[body].angular_velocity += impulses[k] * change.angular_velocity;
    };
    if (response.all.empty()) {
      if (response.rows[k].a != kFixedFrame)
        add(static_cast<std::size_t>(response.rows[k].a), response.of_a[k]);
      if (response.rows[k].b != kFixedFrame)
        add(static_cast<std::size_t>(response.rows[k].b), response.of_b[k]);
    } else {
      for (const std::size_t body : bodies_) add(body, response.all[k * poses_.size() + body]);
    }
  }
}

/// Computes the rows of the active contacts and the matrix C R, and factorises it. With `forces`, responses
/// include the friction of slipping contacts; otherwise they are along the rows themselves, as projections
/// need.
void EquationsOfMotion::linearise_contacts(bool forces) {
  constraints_.clear();
  std::vector<Row<double>> responses, tangents;
  normal_count_ = 0;
  for (const ActiveContact& patch : patches_) {
    for (int i = 0; i < patch.count; ++i) {
      const std::size_t a = patch.a->body, b = patch.b->body;
      const ContactRows rows =
          rows_of(patch.features[i], *patch.a, poses_[a], twists_[a], *patch.b, poses_[b], twists_[b]);
      constraints_.push_back(rows.normal);
      const bool slides = forces && patch.slides();
      responses.push_back(slides ? sum(rows.normal, -patch.mode * patch.sliding_friction, rows.tangent)
                                 : rows.normal);
      if (i == 0 && patch.sticks()) tangents.push_back(rows.tangent);
      ++normal_count_;
    }
  }
  if (held_limit_motors_ > 0) {
    const std::span<const Row<double>> rows = limit_motor_rows();
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (limit_motor_modes_[k] == LimitMotorMode::Held) tangents.push_back(rows[k]);
    }
  }
  constraints_.insert(constraints_.end(), tangents.begin(), tangents.end());
  responses.insert(responses.end(), tangents.begin(), tangents.end());
  find_response(std::move(responses), active_response_);

  const std::size_t n = constraints_.size();
  std::vector<double> matrix;
  scale_.assign(n, 1.0);
  response_matrix(constraints_, active_response_, matrix);
  for (std::size_t i = 0; i < n; ++i) {
    const double own = std::abs(matrix[i * n + i]);
    if (own > 0) scale_[i] = 1 / std::sqrt(own);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) matrix[i * n + k] *= scale_[i] * scale_[k];
  }
  contact_system_.factor(n, matrix, 1e-11);
}

/// Solves (C R) lambda = right_side for the last linearised contacts.
void EquationsOfMotion::solve_contacts(std::span<double> right_side) {
  for (std::size_t i = 0; i < right_side.size(); ++i) right_side[i] *= scale_[i];
  contact_system_.solve_refined(right_side);
  for (std::size_t i = 0; i < right_side.size(); ++i) right_side[i] *= scale_[i];
}

/// Returns the forces that the active contacts had when their modes were decided, by row.
std::vector<double> EquationsOfMotion::decided_forces() const {
  std::vector<double> forces;
  for (const ActiveContact& patch : patches_)
    forces.insert(forces.end(), patch.normal_forces, patch.normal_forces + patch.count);
  for (const ActiveContact& patch : patches_) {
    if (patch.sticks()) forces.push_back(patch.tangential_force);
  }
  assert(forces.size() <= constraints_.size());
  forces.resize(constraints_.size(), 0.0);  // held limits and motors
  return forces;
}

/// Adds the accelerations by contacts to those without them.
void EquationsOfMotion::add_contact_accelerations(std::span<Twist<double>> accelerations) {
  linearise_contacts(true);
  // Forces of redundant contacts are not unique: keep those from the time when the modes were decided, and
  // add the change since then.
  const std::vector<double> decided = decided_forces();
  add_response(active_response_, decided, accelerations);
  contact_right_side_.resize(constraints_.size());
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    contact_right_side_[i] = -(row_speed(constraints_[i], accelerations) + constraints_[i].bias_acceleration);
  }
  std::size_t held = constraints_.size() - held_limit_motors_;
  for (std::size_t k = 0; held_limit_motors_ > 0 && k < limit_motor_modes_.size(); ++k) {
    if (limit_motor_modes_[k] == LimitMotorMode::Held)
      contact_right_side_[held++] += general_joints_.limits_and_motors()[k].speed_at(time_).first;
  }
  solve_contacts(contact_right_side_);
  add_response(active_response_, contact_right_side_, accelerations);
  for (std::size_t i = 0; i < constraints_.size(); ++i) contact_right_side_[i] += decided[i];

  contact_forces_.normal.assign(contact_right_side_.begin(),
                                contact_right_side_.begin() + static_cast<std::ptrdiff_t>(normal_count_));
  contact_forces_.tangent.clear();
  std::size_t point = 0, sticking = normal_count_;
  for (const ActiveContact& patch : patches_) {
    double normal = 0;
    for (int i = 0; i < patch.count; ++i) normal += contact_right_side_[point++];
    contact_forces_.tangent.push_back(patch.sticks() ? contact_right_side_[sticking++]
                                                     : -patch.mode * patch.sliding_friction * normal);
  }
  contact_forces_.limit_motor.assign(contact_right_side_.begin() + static_cast<std::ptrdiff_t>(sticking),
                                     contact_right_side_.end());
}

void EquationsOfMotion::set_limit_motor_modes(std::vector<LimitMotorMode> modes) {
  limit_motor_modes_ = std::move(modes);
  held_limit_motors_ = saturated_motors_ = 0;
  for (const LimitMotorMode mode : limit_motor_modes_) {
    held_limit_motors_ += mode == LimitMotorMode::Held ? 1 : 0;
    saturated_motors_ += mode == LimitMotorMode::Forward || mode == LimitMotorMode::Backward ? 1 : 0;
  }
}

std::span<const Row<double>> EquationsOfMotion::limit_motor_rows() {
  limit_motor_rows_.resize(general_joints_.limits_and_motors().size());
  general_joints_.limit_motor_rows(bodies_view(), limit_motor_rows_);
  return limit_motor_rows_;
}

std::span<const Row<double>> EquationsOfMotion::limit_motor_rows(double time, std::span<const double> y) {
  update_poses(time, y);
  return limit_motor_rows();
}

/// Adds the forces of saturated motors.
void EquationsOfMotion::add_motors() {
  const std::span<const Row<double>> rows = limit_motor_rows();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (limit_motor_modes_[k] != LimitMotorMode::Forward && limit_motor_modes_[k] != LimitMotorMode::Backward)
      continue;
    const double max_force = general_joints_.limits_and_motors()[k].max_force;
    const double force = limit_motor_modes_[k] == LimitMotorMode::Forward ? max_force : -max_force;
    const auto add = [&](int body, Vec2d linear, double angular) {
      if (body == kFixedFrame) return;
      wrenches_[body].force += force * linear;
      wrenches_[body].torque += force * angular;
    };
    add(rows[k].a, rows[k].linear_a, rows[k].angular_a);
    add(rows[k].b, rows[k].linear_b, rows[k].angular_b);
  }
}

/// Adds to `shift` the correction by which velocities (or, with `gaps`, positions) meet the active contacts.
void EquationsOfMotion::close_contacts(std::span<const Twist<double>> motion, bool gaps,
                                       std::span<Twist<double>> shift) {
  contact_right_side_.assign(constraints_.size(), 0.0);
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    if (gaps) {
      contact_right_side_[i] = i < normal_count_
                                   ? -(constraints_[i].residual + row_speed(constraints_[i], shift))
                                   : -row_speed(constraints_[i], shift);
    } else {
      contact_right_side_[i] = -(row_speed(constraints_[i], motion) + row_speed(constraints_[i], shift));
    }
  }
  std::size_t held = constraints_.size() - held_limit_motors_;
  for (std::size_t k = 0; held_limit_motors_ > 0 && k < limit_motor_modes_.size(); ++k) {
    if (limit_motor_modes_[k] != LimitMotorMode::Held) continue;
    const GeneralJoints::LimitOrMotor& limit_motor = general_joints_.limits_and_motors()[k];
    if (gaps && limit_motor.role == RowRole::Limit) contact_right_side_[held] -= constraints_[held].residual;
    if (!gaps && limit_motor.role == RowRole::Motor)
      contact_right_side_[held] += limit_motor.speed_at(time_).value;
    ++held;
  }
  solve_contacts(contact_right_side_);
  add_response(active_response_, contact_right_side_, shift);
}

const ContactForces& EquationsOfMotion::contact_forces(double time, std::span<const double> y) {
  scratch_.resize(y.size());
  rate(time, y, scratch_);
  return contact_forces_;
}

void EquationsOfMotion::compute_response(double time, std::span<const double> y,
                                         std::vector<Row<double>> rows, ContactResponse& response,
                                         std::vector<double>& matrix) {
  update_poses(time, y);
  if (has_joints_) linearise();
  find_response(std::move(rows), response);
  response_matrix(response.rows, response, matrix);
}

void EquationsOfMotion::apply_impulses(const ContactResponse& response, std::span<const double> impulses,
                                       Compensated& y) const {
  std::vector<Twist<double>> change(poses_.size());
  add_response(response, impulses, change);
  add_velocities(change, 1, y);
}

std::span<const Twist<double>> EquationsOfMotion::accelerations_without_contacts(double time,
                                                                                 std::span<const double> y) {
  std::vector<ActiveContact> held;
  std::size_t limit_motors = 0;
  std::swap(held, patches_);
  std::swap(limit_motors, held_limit_motors_);
  scratch_.resize(y.size());
  rate(time, y, scratch_);
  std::swap(held, patches_);
  std::swap(limit_motors, held_limit_motors_);
  return accelerations_;
}

}  // namespace plumb::precise
