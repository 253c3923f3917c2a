#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/math/vec2.h"
#include "engine/world/handles.h"

namespace plumb {

/// Two shapes began or ceased to touch. A shape that was destroyed meanwhile has a handle that is gone.
struct TouchEvent {
  ShapeId shape_a{}, shape_b{};
};

/// Two shapes met hard.
struct HitEvent {
  ShapeId shape_a{}, shape_b{};
  Vec2d point{};     ///< m
  Vec2d normal{};    ///< from a to b
  double speed = 0;  ///< m/s, of approach
};

struct SensorEvent {
  ShapeId sensor{}, visitor{};
};

struct JointEvent {
  JointId joint{};  ///< gone: it broke
};

/// What of a body went bad.
enum class BadField : std::uint8_t { Force, Torque, Velocity, AngularVelocity };
inline constexpr const char* kBadFieldNames[] = {"force", "torque", "velocity", "angular_velocity"};

/// A body was taken out of the motion, because a number of it was none, or beyond 1e12.
struct QuarantineEvent {
  BodyId body{};
  std::string name{};     ///< the body's, as it was made
  BadField field{};       ///< what a law returned, or what a step led to
  double value = 0;       ///< the first bad part of it: SI units
  std::int64_t step = 0;  ///< that it would have spoiled, from 1
};

/// What happened in the last step (and, for the endings, since the one before); the next step empties it.
/// What began ends once, whatever happens to it. Bodies that wake and fall asleep over and over between two
/// steps may be told of once.
struct Events {
  std::vector<TouchEvent> begin, end;
  std::vector<HitEvent> hits;
  std::vector<SensorEvent> sensor_begin, sensor_end;
  std::vector<JointEvent> broken;
  std::vector<BodyId> fell_asleep, woke;
  std::vector<QuarantineEvent> quarantined;

  void clear() {
    begin.clear(), end.clear(), hits.clear(), sensor_begin.clear(), sensor_end.clear(), broken.clear();
    fell_asleep.clear(), woke.clear(), quarantined.clear();
  }
};

}  // namespace plumb
