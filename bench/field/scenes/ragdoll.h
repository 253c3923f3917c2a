#pragma once

#include <array>

#include "bench/field/builder.h"

namespace plumb::field {

inline constexpr int kBones = 11;

/// Adds a person 1.6 m high, standing at `position`: 11 bodies of capsules, feet of rounded polygons, 10
/// revolute joints. Joints have limits, friction (0.05 N m times a bone's own factor) and springs (5 Hz,
/// damping ratio 0.5). Shapes of the same `group` do not collide; feet collide only with the ground (category
/// 1).
std::array<int, kBones> add_ragdoll(Builder& world, Vec2d position, int group);

}  // namespace plumb::field
