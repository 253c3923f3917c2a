#include "harness/joint_gap.h"

#include <cmath>

#include "engine/math/trigonometry.h"

namespace plumb::harness {
namespace {

Vec2d anchor_of(const JointGaps::End& end, std::span<const BodyState> states) {
  if (!end.body) return end.anchor;
  const BodyState& state = states[*end.body];
  const Rotation<double> turn = rotation_of(state.angle);
  return state.position + turn * end.anchor;
}

}  // namespace

JointGaps::JointGaps(const Scene& scene) {
  for (const Joint& joint : scene.joints) {
    Entry entry;
    std::visit(
        [&](const auto& j) {
          entry.a = {find_body(scene, j.body_a), j.anchor_a};
          entry.b = {find_body(scene, j.body_b), j.anchor_b};
        },
        joint);
    if (const auto* rod = std::get_if<DistanceJoint>(&joint)) entry.length = rod->length;
    joints_.push_back(entry);
  }
}

double JointGaps::gap(std::size_t joint, std::span<const BodyState> states) const {
  const Entry& entry = joints_[joint];
  const Vec2d apart = anchor_of(entry.b, states) - anchor_of(entry.a, states);
  return std::abs(std::hypot(apart.x, apart.y) - entry.length);
}

}  // namespace plumb::harness
