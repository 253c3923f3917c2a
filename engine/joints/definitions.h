#pragma once

#include <optional>
#include <variant>

#include "engine/math/vec2.h"
#include "engine/scene/joint.h"

/// Definitions of joints of the real-time world. Anchors are in the frames of their bodies (from the body's
/// origin, not its centre of mass); angles in rad, counter-clockwise, of b relative to a. `SceneJoint` has
/// the same fields (engine/scene/joint_fields.h).
namespace plumb {

/// Distance between two anchors: a rod, a spring when `spring` is given, a rope when `range` is.
struct DistanceDefinition {
  using SceneJoint = DistanceJoint;
  Vec2d anchor_a{}, anchor_b{};
  double length = 1;  ///< m, > 0: of the rod, or of the spring at rest
  std::optional<Spring> spring{};
  std::optional<Range> range{};  ///< m; with it the rod is free inside the range
  std::optional<Motor> motor{};  ///< along the line of the anchors
};

/// A common point; the bodies turn about it.
struct RevoluteDefinition {
  using SceneJoint = RevoluteJoint;
  Vec2d anchor_a{}, anchor_b{};
  double reference_angle = 0;     ///< rad, of b relative to a, where the joint's angle is 0
  std::optional<Range> limits{};  ///< rad
  std::optional<Motor> motor{};   ///< rad/s, N m
  std::optional<Spring> spring{};
  double target_angle = 0;  ///< rad, of the spring
};

/// Slides along an axis of a without turning.
struct PrismaticDefinition {
  using SceneJoint = PrismaticJoint;
  Vec2d anchor_a{}, anchor_b{};
  Vec2d axis{1, 0};  ///< in a's frame, any length > 0
  double reference_angle = 0;
  std::optional<Range> limits{};  ///< m
  std::optional<Motor> motor{};   ///< m/s, N
  std::optional<Spring> spring{};
  double target_translation = 0;  ///< m, of the spring
};

/// Holds b to a; rigid without springs.
struct WeldDefinition {
  using SceneJoint = WeldJoint;
  Vec2d anchor_a{}, anchor_b{};
  double reference_angle = 0;
  std::optional<Spring> linear_spring{}, angular_spring{};
};

/// A wheel b on a suspension along an axis of a: free to turn, rigid across the axis.
struct WheelDefinition {
  using SceneJoint = WheelJoint;
  Vec2d anchor_a{}, anchor_b{};
  Vec2d axis{0, 1};
  std::optional<Spring> spring{};
  std::optional<Range> limits{};  ///< m, along the axis
  std::optional<Motor> motor{};   ///< rad/s, N m
};

/// Drives b towards a pose relative to a with limited force and torque.
struct MotorDefinition {
  using SceneJoint = MotorJoint;
  Vec2d target_position{};  ///< m, of b's origin in a's frame
  double target_angle = 0;  ///< rad
  double max_force = 0;     ///< N
  double max_torque = 0;    ///< N m
  Spring spring{2, 1};      ///< of its response
};

/// Pulls a point of b towards a point of the world (a is any static body).
struct MouseDefinition {
  using SceneJoint = MouseJoint;
  Vec2d anchor_b{};
  Vec2d target{};  ///< m, in the world
  Spring spring{5, 0.7};
  double max_force = 0;  ///< N
};

/// angle_b = ratio angle_a + phase: meshing wheels have a negative ratio.
struct GearDefinition {
  using SceneJoint = GearJoint;
  double ratio = -1;  ///< not 0
  double phase = 0;   ///< rad
};

/// A rope over two pulleys: length_a + ratio length_b stays constant.
struct PulleyDefinition {
  using SceneJoint = PulleyJoint;
  Vec2d ground_a{}, ground_b{};  ///< m, in the world
  Vec2d anchor_a{}, anchor_b{};
  double ratio = 1;                ///< > 0
  std::optional<double> length{};  ///< m, of length_a + ratio length_b; absent: as placed
};

/// Lets b turn relative to a in one direction, and stops it in the other at teeth `tooth` apart.
struct RatchetDefinition {
  using SceneJoint = RatchetJoint;
  double tooth = 0.1;  ///< rad, not 0; its sign is the free direction
  double phase = 0;    ///< rad, the position of a tooth
};

/// Resists motion of b relative to a with limited force and torque (top-down friction).
struct FrictionDefinition {
  using SceneJoint = FrictionJoint;
  Vec2d anchor_a{}, anchor_b{};
  double max_force = 0;   ///< N
  double max_torque = 0;  ///< N m
};

using JointKind = std::variant<DistanceDefinition, RevoluteDefinition, PrismaticDefinition, WeldDefinition,
                               WheelDefinition, MotorDefinition, MouseDefinition, GearDefinition,
                               PulleyDefinition, RatchetDefinition, FrictionDefinition>;

}  // namespace plumb
