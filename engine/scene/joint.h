#pragma once

#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "engine/math/vec2.h"

/// The joints of a scene, in SI units; angles in rad, counter-clockwise, of b relative to a.
namespace plumb {

/// A damped spring, given by its natural frequency with the joined bodies' effective mass and its damping
/// ratio.
struct Spring {
  double hertz = 0;          ///< 1/s, > 0
  double damping_ratio = 1;  ///< 1 is critical, >= 0
  friend bool operator==(const Spring&, const Spring&) = default;
};

/// Lowest and highest value, lower <= upper.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  friend bool operator==(const Range&, const Range&) = default;
};

/// Drives a joint towards a speed with limited force or torque.
struct Motor {
  double speed = 0;      ///< m/s or rad/s
  double max_force = 0;  ///< N or N m, >= 0
  friend bool operator==(const Motor&, const Motor&) = default;
};

/// Holds two anchors together; the bodies rotate freely about them within the limits.
struct RevoluteJoint {
  std::string name;    ///< unique, not empty
  std::string body_a;  ///< a body's name, or "world"
  std::string body_b;
  Vec2d anchor_a{};               ///< m, in body a's frame
  Vec2d anchor_b{};               ///< m, in body b's frame
  bool collide = false;           ///< true: the two bodies may also touch
  double break_force = 0;         ///< N, at which the joint breaks; 0: never
  double break_torque = 0;        ///< N m; 0: never
  double reference_angle = 0;     ///< rad, of b relative to a, where the joint's angle is 0
  std::optional<Range> limits{};  ///< rad
  std::optional<Motor> motor{};   ///< rad/s, N m
  std::optional<Spring> spring{};
  double target_angle = 0;  ///< rad, of the spring
  friend bool operator==(const RevoluteJoint&, const RevoluteJoint&) = default;
};

/// Holds two anchors at a distance: a massless rod; a spring when `spring` is given, a rope when `range` is.
struct DistanceJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  Vec2d anchor_a{};
  Vec2d anchor_b{};
  double length = 0;  ///< m, > 0: of the rod, or of the spring at rest
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  std::optional<Spring> spring{};
  std::optional<Range> range{};  ///< m; with it the anchors are free inside the range
  std::optional<Motor> motor{};  ///< along the line of the anchors
  friend bool operator==(const DistanceJoint&, const DistanceJoint&) = default;
};

/// Lets b slide along an axis of a, without rotation.
struct PrismaticJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  Vec2d anchor_a{};
  Vec2d anchor_b{};
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  Vec2d axis{1, 0};  ///< in a's frame, any length > 0
  double reference_angle = 0;
  std::optional<Range> limits{};  ///< m
  std::optional<Motor> motor{};   ///< m/s, N
  std::optional<Spring> spring{};
  double target_translation = 0;  ///< m, of the spring
  friend bool operator==(const PrismaticJoint&, const PrismaticJoint&) = default;
};

/// Holds b to a; rigid without springs.
struct WeldJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  Vec2d anchor_a{};
  Vec2d anchor_b{};
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  double reference_angle = 0;
  std::optional<Spring> linear_spring{}, angular_spring{};
  friend bool operator==(const WeldJoint&, const WeldJoint&) = default;
};

/// A wheel b on a suspension along an axis of a: free to rotate, rigid across the axis.
struct WheelJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  Vec2d anchor_a{};
  Vec2d anchor_b{};
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  Vec2d axis{0, 1};
  std::optional<Spring> spring{};
  std::optional<Range> limits{};  ///< m, along the axis
  std::optional<Motor> motor{};   ///< rad/s, N m
  friend bool operator==(const WheelJoint&, const WheelJoint&) = default;
};

/// Drives b towards a pose relative to a with limited force and torque.
struct MotorJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  Vec2d target_position{};  ///< m, of b's centre of mass in a's frame
  double target_angle = 0;  ///< rad
  double max_force = 0;     ///< N, >= 0
  double max_torque = 0;    ///< N m, >= 0
  Spring spring{2, 1};      ///< of its response
  friend bool operator==(const MotorJoint&, const MotorJoint&) = default;
};

/// Pulls a point of b towards a point of the world. Body a is not involved; it is "world" or a static body.
struct MouseJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  Vec2d anchor_b{};
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  Vec2d target{};  ///< m, in the world
  Spring spring{5, 0.7};
  double max_force = 0;  ///< N, >= 0
  friend bool operator==(const MouseJoint&, const MouseJoint&) = default;
};

/// angle_b = ratio angle_a + phase: meshing wheels have a negative ratio.
struct GearJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  double ratio = -1;  ///< not 0
  double phase = 0;   ///< rad
  friend bool operator==(const GearJoint&, const GearJoint&) = default;
};

/// A rope over two pulleys: length_a + ratio length_b stays constant.
struct PulleyJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  Vec2d anchor_a{};
  Vec2d anchor_b{};
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  Vec2d ground_a{}, ground_b{};    ///< m, in the world
  double ratio = 1;                ///< > 0
  std::optional<double> length{};  ///< m, > 0, of length_a + ratio length_b; absent: as placed
  friend bool operator==(const PulleyJoint&, const PulleyJoint&) = default;
};

/// Lets b rotate relative to a in one direction, and stops it in the other at teeth `tooth` apart.
struct RatchetJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  double tooth = 0.1;  ///< rad, not 0; its sign is the free direction
  double phase = 0;    ///< rad, the position of a tooth
  friend bool operator==(const RatchetJoint&, const RatchetJoint&) = default;
};

/// Resists motion of b relative to a with limited force and torque (top-down friction).
struct FrictionJoint {
  std::string name;
  std::string body_a;
  std::string body_b;
  Vec2d anchor_a{};
  Vec2d anchor_b{};
  bool collide = false;
  double break_force = 0;
  double break_torque = 0;
  double max_force = 0;   ///< N, >= 0
  double max_torque = 0;  ///< N m, >= 0
  friend bool operator==(const FrictionJoint&, const FrictionJoint&) = default;
};

using Joint = std::variant<RevoluteJoint, DistanceJoint, PrismaticJoint, WeldJoint, WheelJoint, MotorJoint,
                           MouseJoint, GearJoint, PulleyJoint, RatchetJoint, FrictionJoint>;

}  // namespace plumb
