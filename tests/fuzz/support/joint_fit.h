#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>

#include "engine/world/world.h"

namespace plumb::fuzz {

/// A joint as a game makes it: it holds bodies where they are, and its limits let them be there.
struct Fit {
  Vec2d point_a{}, point_b{};       // m, of the anchors, in the world
  Vec2d anchor_b{};                 // m, in b's frame, of the point where a's anchor is
  double angle_a = 0, angle_b = 0;  // rad

  template <class Joint>
  void operator()(Joint& joint) const {
    if constexpr (requires { joint.reference_angle; }) joint.reference_angle = angle_b - angle_a;
    if constexpr (requires { joint.limits; }) {
      if (joint.limits)
        *joint.limits = {std::min(joint.limits->lower, 0.0), std::max(joint.limits->upper, 0.0)};
    }
    if constexpr (std::is_same_v<Joint, DistanceDefinition>) {
      joint.length = std::max(0.1, std::sqrt(length_squared(point_b - point_a)));
      if (joint.range)
        *joint.range = {std::min(joint.range->lower, joint.length),
                        std::max(joint.range->upper, joint.length)};
    } else if constexpr (std::is_same_v<Joint, PulleyDefinition>) {
      joint.length.reset();
    } else if constexpr (std::is_same_v<Joint, GearDefinition>) {
      joint.ratio = joint.ratio < 0 ? std::min(joint.ratio, -0.25) : std::max(joint.ratio, 0.25);
      joint.phase = angle_b - joint.ratio * angle_a;
    } else if constexpr (std::is_same_v<Joint, RatchetDefinition>) {
      joint.tooth = joint.tooth < 0 ? std::min(joint.tooth, -0.05) : std::max(joint.tooth, 0.05);
      joint.phase = angle_b - angle_a;
    } else if constexpr (requires { joint.anchor_a; }) {
      joint.anchor_b = anchor_b;
    }
  }
};

/// Makes `kind` one that holds two bodies of a world where they are.
template <class Real>
void fit(const BasicWorld<Real>& world, BodyId a, BodyId b, JointKind& kind) {
  const auto anchors = std::visit(
      [](const auto& joint) -> std::pair<Vec2d, Vec2d> {
        if constexpr (requires { joint.anchor_a; }) return {joint.anchor_a, joint.anchor_b};
        return {};
      },
      kind);
  const Vec2d point_a = world.world_point(a, anchors.first), point_b = world.world_point(b, anchors.second);
  std::visit(Fit{point_a, point_b, world.local_point(b, point_a), world.angle(a), world.angle(b)}, kind);
}

}  // namespace plumb::fuzz
