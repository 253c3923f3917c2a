#include <algorithm>
#include <variant>

#include "engine/precise/dynamics/motion.h"

// Computes the forces of joints and of persistent contacts on request.
namespace plumb::precise {

std::vector<EquationsOfMotion::JointEnd> EquationsOfMotion::ends_of_joints(const Scene& scene) {
  std::vector<JointEnd> ends;
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          JointEnd end{j.name, kFixedFrame, {}};
          if (const auto body = find_body(scene, j.body_b)) end.body = static_cast<int>(*body);
          if constexpr (requires { j.anchor_b; }) end.anchor = j.anchor_b;
          ends.push_back(end);
        },
        joint);
  }
  return ends;
}

/// Computes the joints' multipliers under the forces of contacts, limits and motors of the last evaluation.
/// `add_contact_accelerations` sums only the responses to these forces, without the multipliers.
void EquationsOfMotion::find_multipliers_with_contacts(double time, std::span<const double> y) {
  free_accelerations(time, y, accelerations_);
  for (std::size_t k = 0; k < active_response_.rows.size(); ++k) {
    const auto add = [&](int body, const Twist<double>& by_one) {
      if (body == kFixedFrame) return;
      accelerations_[body].velocity += contact_right_side_[k] * by_one.velocity;
      accelerations_[body].angular_velocity += contact_right_side_[k] * by_one.angular_velocity;
    };
    add(active_response_.rows[k].a, active_response_.of_a[k]);
    add(active_response_.rows[k].b, active_response_.of_b[k]);
  }
  for (std::size_t r = 0; r < rows_.size(); ++r)
    right_side_[r] = -(row_speed(rows_[r], accelerations_) + rows_[r].bias_acceleration);
  solve_joints();
}

Reactions EquationsOfMotion::reactions(double time, std::span<const double> y) {
  const std::int64_t before = evaluations_;
  scratch_.resize(y.size());
  rate_with_rows(time, y, scratch_);
  if (has_joints_ && has_active_constraints()) find_multipliers_with_contacts(time, y);
  evaluations_ = before;

  Reactions out;
  for (const JointEnd& end : joint_ends_) out.joints.push_back({end.joint, {}, {}, 0});
  const auto add = [&](const std::string& joint, Vec2d force, double torque) {
    const auto at = std::find_if(out.joints.begin(), out.joints.end(),
                                 [&](const JointReaction& r) { return r.joint == joint; });
    at->force += force, at->torque += torque;
  };
  const auto add_row = [&](const std::string& joint, const Row<double>& row, double multiplier) {
    add(joint, multiplier * row.linear_b, multiplier * row.angular_b);
  };
  if (has_joints_) {
    for (std::size_t r = 0; r < rows_.size(); ++r) add_row(joint_of_row_[r], rows_[r], multipliers_[r]);
  }
  general_joints_.for_each_spring(bodies_view(), add);
  const std::span<const Row<double>> limit_motors = limit_motor_rows();
  std::size_t held = 0;
  for (std::size_t k = 0; k < limit_motor_modes_.size(); ++k) {
    const GeneralJoints::LimitOrMotor& limit_motor = general_joints_.limits_and_motors()[k];
    if (limit_motor_modes_[k] == LimitMotorMode::Free) continue;
    const double force = limit_motor_modes_[k] == LimitMotorMode::Held ? contact_forces_.limit_motor[held++]
                         : limit_motor_modes_[k] == LimitMotorMode::Forward ? limit_motor.max_force
                                                                            : -limit_motor.max_force;
    add_row(limit_motor.joint, limit_motors[k], force);
  }
  for (std::size_t k = 0; k < joint_ends_.size(); ++k) {
    const JointEnd& end = joint_ends_[k];
    JointReaction& joint = out.joints[k];
    const Pose<double> pose = end.body == kFixedFrame ? Pose<double>{} : poses_[end.body];
    const Vec2d arm = pose.rotation * end.anchor;
    joint.position = pose.position + arm;
    joint.torque -= cross(arm, joint.force);
  }
  std::size_t point = 0;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const ActiveContact& patch = patches_[p];
    for (int i = 0; i < patch.count; ++i) {
      const Gap gap =
          gap_of(patch.features[i], *patch.a, poses_[patch.a->body], *patch.b, poses_[patch.b->body]);
      out.contacts.push_back({patch.a->body, patch.b->body, gap.point, gap.normal,
                              contact_forces_.normal[point++], i == 0 ? contact_forces_.tangent[p] : 0});
    }
  }
  return out;
}

}  // namespace plumb::precise
