#include "engine/precise/dynamics/initial_joint_errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include "engine/core/text.h"
#include "engine/joints/joints.h"
#include "engine/math/trigonometry.h"
#include "engine/precise/dynamics/active_contact.h"
#include "engine/precise/dynamics/joints.h"

namespace plumb {
namespace {

using precise::rate_along;

struct Start {
  std::vector<Pose<double>> poses;
  std::vector<double> angles;
  std::vector<Twist<double>> twists;

  explicit Start(const Scene& scene) {
    for (const Body& body : scene.bodies) {
      const BodyState s = initial_state(body);
      poses.push_back({s.position, rotation_of(s.angle)});
      angles.push_back(s.angle);
      twists.push_back({s.velocity, s.angular_velocity});
    }
  }
};

/// Returns the names of the joints to which plain rows belong, in the order of `Joints::rows`.
std::vector<std::string> plain_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Joint& joint : scene.joints) {
    if (const auto* hinge = std::get_if<RevoluteJoint>(&joint)) names.insert(names.end(), 2, hinge->name);
  }
  for (const Joint& joint : scene.joints) {
    if (const auto* rod = std::get_if<DistanceJoint>(&joint); rod && !rod->spring && !rod->range)
      names.push_back(rod->name);
  }
  return names;
}

}  // namespace

std::vector<InitialJointError> initial_joint_errors(const Scene& scene) {
  const Start start(scene);
  const Joints plain = compile_joints(scene);
  const precise::GeneralJoints others(scene);
  std::vector<Row<double>> rows(plain.row_count() + others.row_count()),
      limit_motors(others.limits_and_motors().size());
  plain.rows(start.poses, start.twists, rows);
  const precise::BodiesView now{start.poses, start.angles, start.twists};
  others.rows(now, std::span(rows).subspan(plain.row_count()));
  others.limit_motor_rows(now, limit_motors);
  std::vector<std::string> names = plain_names(scene);
  names.insert(names.end(), others.row_names().begin(), others.row_names().end());

  std::vector<InitialJointError> found;
  std::map<std::pair<std::string, bool>, std::size_t> index_of;
  const auto offer = [&](const std::string& joint, const Row<double>& row, double gap, double speed) {
    const bool is_angle = row.linear_a == Vec2d{} && row.linear_b == Vec2d{};
    auto [at, fresh] = index_of.try_emplace({joint, is_angle}, found.size());
    if (fresh) found.push_back({joint, is_angle, 0, 0});
    InitialJointError& start_of = found[at->second];
    start_of.gap = std::max(start_of.gap, gap);
    start_of.speed = std::max(start_of.speed, speed);
  };
  for (std::size_t r = 0; r < rows.size(); ++r)
    offer(names[r], rows[r], std::abs(rows[r].residual), std::abs(rate_along(rows[r], start.twists)));
  for (std::size_t k = 0; k < limit_motors.size(); ++k) {
    if (others.limits_and_motors()[k].role == RowRole::Limit)
      offer(others.limits_and_motors()[k].joint, limit_motors[k], std::max(-limit_motors[k].residual, 0.0),
            0);
  }
  return found;
}

std::vector<std::string> describe_joint_errors(const Scene& scene, double gap, double speed) {
  std::vector<std::string> out;
  for (const InitialJointError& start : initial_joint_errors(scene)) {
    const std::string name = "joint " + quoted(start.joint), unit = start.is_angle ? "rad" : "m";
    if (start.gap > gap)
      out.push_back(name + " is off by " + shortest(start.gap) + " " + unit + " where the scene starts");
    if (start.speed > speed)
      out.push_back(name + " holds what moves at " + shortest(start.speed) + " " + unit +
                    "/s where the scene starts");
  }
  return out;
}

}  // namespace plumb
