#include "harness/joint_gap.h"

#include <algorithm>
#include <cmath>

#include "engine/math/trigonometry.h"
#include "harness/magnitude.h"

namespace plumb::harness {
namespace {

Vec2d anchor_of(const JointGaps::End& end, std::span<const BodyState> states) {
  if (!end.body) return end.anchor;
  const BodyState& state = states[*end.body];
  return state.position + rotation_of(state.angle) * end.anchor;
}

/// Current anchors of a joint, and body a's angle.
struct Placed {
  Vec2d a, b;
  double angle_a;
};

double rope_length(const PulleyJoint& pulley, const Placed& at) {
  return magnitude(at.a - pulley.ground_a) + pulley.ratio * magnitude(at.b - pulley.ground_b);
}

double outside(const std::optional<Range>& range, double value) {
  return range ? std::max({range->lower - value, value - range->upper, 0.0}) : 0;
}

// Returns the distance of b's anchor from the allowed part of a's axis.
double off_axis(const auto& joint, const Placed& at) {
  const Vec2d axis = (1 / magnitude(joint.axis)) * (rotation_of(at.angle_a) * joint.axis), way = at.b - at.a;
  return std::hypot(cross(axis, way), outside(joint.limits, dot(axis, way)));
}

struct Gap {
  const Placed& at;
  double rope;

  double operator()(const RevoluteJoint&) const { return magnitude(at.b - at.a); }
  double operator()(const DistanceJoint& j) const {
    const double length = magnitude(at.b - at.a);
    if (j.range) return outside(j.range, length);
    return j.spring ? 0 : std::abs(length - j.length);
  }
  double operator()(const WeldJoint& j) const { return j.linear_spring ? 0 : magnitude(at.b - at.a); }
  double operator()(const PrismaticJoint& j) const { return off_axis(j, at); }
  double operator()(const WheelJoint& j) const { return off_axis(j, at); }
  double operator()(const PulleyJoint& j) const { return std::abs(rope_length(j, at) - rope); }
  double operator()(const auto&) const { return 0; }
};

Placed place(const JointGaps::End& a, const JointGaps::End& b, std::span<const BodyState> states) {
  return {anchor_of(a, states), anchor_of(b, states), a.body ? states[*a.body].angle : 0};
}

}  // namespace

JointGaps::JointGaps(const Scene& scene) {
  std::vector<BodyState> start;
  for (const Body& body : scene.bodies) start.push_back(initial_state(body));
  for (const Joint& joint : scene.joints) {
    Entry entry{joint, {}, {}, 0};
    std::visit(
        [&](const auto& j) {
          entry.a.body = find_body(scene, j.body_a);
          entry.b.body = find_body(scene, j.body_b);
          if constexpr (requires { j.anchor_a; }) entry.a.anchor = j.anchor_a;
          if constexpr (requires { j.anchor_b; }) entry.b.anchor = j.anchor_b;
        },
        joint);
    if (const auto* pulley = std::get_if<PulleyJoint>(&joint)) entry.b.gain = pulley->ratio;
    if (const auto* pulley = std::get_if<PulleyJoint>(&joint))
      entry.rope = pulley->length ? *pulley->length : rope_length(*pulley, place(entry.a, entry.b, start));
    joints_.push_back(std::move(entry));
  }
}

double JointGaps::gap(std::size_t joint, std::span<const BodyState> states) const {
  const Entry& entry = joints_[joint];
  const Placed at = place(entry.a, entry.b, states);
  return std::visit(Gap{at, entry.rope}, entry.joint);
}

double JointGaps::lever(std::size_t joint, std::span<const BodyState> states) const {
  const Entry& entry = joints_[joint];
  const bool has_axis =
      std::holds_alternative<PrismaticJoint>(entry.joint) || std::holds_alternative<WheelJoint>(entry.joint);
  if (!has_axis || !entry.a.body) return 0;
  const Placed at = place(entry.a, entry.b, states);
  return magnitude(at.b - at.a);
}

}  // namespace plumb::harness
