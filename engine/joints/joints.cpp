#include "engine/joints/joints.h"

#include <cmath>
#include <map>
#include <string_view>

namespace plumb {
namespace {

template <class T>
T of_body(std::span<const T> values, int body) {
  return body == kFixedFrame ? T{} : values[static_cast<std::size_t>(body)];
}

}  // namespace

// C = (x_b + R_b s_b) - (x_a + R_a s_a), r = R s.   dC/dt = v_b + w_b z x r_b - v_a - w_a z x r_a.
// (dJ/dt) v = -w_b^2 r_b + w_a^2 r_a: the centripetal accelerations of the anchors.
void Revolute::rows(const Pose<double>& pose_a, const Pose<double>& pose_b, const Twist<double>& twist_a,
                    const Twist<double>& twist_b, Row<double>* out) const {
  const Vec2d arm_a = pose_a.rotation * anchor_a;
  const Vec2d arm_b = pose_b.rotation * anchor_b;
  const Vec2d gap = (pose_b.position - pose_a.position) + (arm_b - arm_a);
  const double spin_a = twist_a.angular_velocity * twist_a.angular_velocity;
  const double spin_b = twist_b.angular_velocity * twist_b.angular_velocity;
  const Vec2d bias = spin_a * arm_a - spin_b * arm_b;
  out[0] = {a, b, {-1, 0}, {1, 0}, arm_a.y, -arm_b.y, gap.x, bias.x};
  out[1] = {a, b, {0, -1}, {0, 1}, -arm_a.x, arm_b.x, gap.y, bias.y};
}

// C = |d| - length, d from anchor a to anchor b, u = d / |d|.   dC/dt = u . dd/dt.
// (dJ/dt) v = u . (w_a^2 r_a - w_b^2 r_b) + (|dd/dt|^2 - (u . dd/dt)^2) / |d|: the anchors' centripetal
// accelerations along the rod, and that of the rod's own rotation.
void Distance::rows(const Pose<double>& pose_a, const Pose<double>& pose_b, const Twist<double>& twist_a,
                    const Twist<double>& twist_b, Row<double>* out) const {
  const Vec2d arm_a = pose_a.rotation * anchor_a;
  const Vec2d arm_b = pose_b.rotation * anchor_b;
  const Vec2d d = (pose_b.position - pose_a.position) + (arm_b - arm_a);
  const Vec2d rate = (twist_b.velocity - twist_a.velocity) +
                     (cross(twist_b.angular_velocity, arm_b) - cross(twist_a.angular_velocity, arm_a));
  const double separation = std::sqrt(length_squared(d));
  // Coinciding anchors have no direction: any one separates them, and the rod's rotation is undefined.
  const bool apart = separation > 0;
  const Vec2d u = apart ? (1 / separation) * d : Vec2d{1, 0};
  const double sideways = cross(u, rate);
  const double turning = apart ? sideways * sideways / separation : 0;
  const double spin_a = twist_a.angular_velocity * twist_a.angular_velocity;
  const double spin_b = twist_b.angular_velocity * twist_b.angular_velocity;
  *out = {a,
          b,
          -u,
          u,
          -cross(arm_a, u),
          cross(arm_b, u),
          separation - length,
          dot(u, spin_a * arm_a - spin_b * arm_b) + turning};
}

void Joints::rows(std::span<const Pose<double>> poses, std::span<const Twist<double>> twists,
                  std::span<Row<double>> out) const {
  Row<double>* next = out.data();
  const auto all_of = [&](const auto& joints) {
    for (const auto& joint : joints) {
      joint.rows(of_body(poses, joint.a), of_body(poses, joint.b), of_body(twists, joint.a),
                 of_body(twists, joint.b), next);
      next += joint.kRows;
    }
  };
  all_of(revolute);
  all_of(distance);
}

Joints compile_joints(const Scene& scene) {
  std::map<std::string_view, int> index{{kWorld, kFixedFrame}};
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    index.emplace(scene.bodies[i].name, static_cast<int>(i));
  }
  Joints joints;
  for (const Joint& joint : scene.joints) {
    if (const auto* hinge = std::get_if<RevoluteJoint>(&joint)) {
      joints.revolute.push_back(
          {index.at(hinge->body_a), index.at(hinge->body_b), hinge->anchor_a, hinge->anchor_b});
    } else if (const auto* rod = std::get_if<DistanceJoint>(&joint); rod && !rod->spring && !rod->range) {
      joints.distance.push_back(
          {index.at(rod->body_a), index.at(rod->body_b), rod->anchor_a, rod->anchor_b, rod->length});
    }
  }
  return joints;
}

}  // namespace plumb
