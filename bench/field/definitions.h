#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/math/vec2.h"

namespace plumb::field {

/// Parts of the scenes, in SI units, y up. Every engine gets the same parts.

struct Circle {
  Vec2d centre{};  ///< m, in the body's frame
  double radius = 0;
};

struct Capsule {
  Vec2d a{}, b{};  ///< m, the ends of its axis
  double radius = 0;
};

/// Convex, counter-clockwise, enlarged by `radius`.
struct Polygon {
  std::vector<Vec2d> points;
  double radius = 0;
};

/// A two-sided segment.
struct Segment {
  Vec2d a{}, b{};
};

using Geometry = std::variant<Circle, Capsule, Polygon, Segment>;

inline Polygon box(double half_width, double half_height, Vec2d centre = {}, double radius = 0) {
  const Vec2d w{half_width, 0}, h{0, half_height};
  return {{centre - w - h, centre + w - h, centre + w + h, centre - w + h}, radius};
}

struct ShapeDefinition {
  Geometry geometry;
  double density = 1;          ///< kg/m^2
  double friction = 0.6;       ///< of a pair the geometric mean is used
  double restitution = 0;      ///< of a pair the larger one is used
  int group = 0;               ///< shapes of the same group, other than 0, never collide
  std::uint16_t category = 1;  ///< else two shapes collide if the mask of each has the other's category
  std::uint16_t mask = std::numeric_limits<std::uint16_t>::max();
};

enum class BodyType { Static, Kinematic, Dynamic };

struct BodyDefinition {
  BodyType type = BodyType::Dynamic;
  Vec2d position{};            ///< m, of the frame's origin
  double angle = 0;            ///< rad
  Vec2d velocity{};            ///< m/s, of the centre of mass
  double spin = 0;             ///< rad/s
  double linear_damping = 0;   ///< 1/s
  double angular_damping = 0;  ///< 1/s
  double gravity_scale = 1;
  bool bullet = false;  ///< continuous collision against dynamic bodies too
};

struct Limits {
  double lower = 0, upper = 0;  ///< rad
};

struct Motor {
  double speed = 0;       ///< rad/s
  double max_torque = 0;  ///< N m
};

struct AngularSpring {
  double hertz = 0;
  double damping_ratio = 0;
};

/// Pins two anchors together. The joint's angle is that of b minus that of a minus `reference_angle`.
struct RevoluteDefinition {
  Vec2d anchor_a{}, anchor_b{};  ///< m, each in its body's frame
  double reference_angle = 0;    ///< rad
  std::optional<Limits> limits{};
  std::optional<Motor> motor{};
  std::optional<AngularSpring> spring{};  ///< spring towards the angle 0
  bool collide = false;                   ///< true if the joined bodies collide with each other
};

/// Handle of a body in its engine.
struct BodyHandle {
  std::uint64_t bits = 0;
};

struct BodyState {
  Vec2d position{};  ///< m, of the frame's origin
  double angle = 0;  ///< rad
  Vec2d velocity{};  ///< m/s, of the centre of mass
  double spin = 0;   ///< rad/s
};

struct Counts {
  int bodies = 0, shapes = 0, joints = 0;
  int touching = 0;  ///< contacts that the engine itself reports as touching
};

/// Names of a step's stages and the time of each, ns.
using StageTimes = std::vector<std::pair<std::string, double>>;

/// Names and values of an engine's settings.
using Settings = std::vector<std::pair<std::string, std::string>>;

}  // namespace plumb::field
