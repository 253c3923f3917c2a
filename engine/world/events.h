#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/math/vec2.h"
#include "engine/world/handles.h"

namespace plumb {

/// Two shapes began or ceased to touch. The handle of a shape that was destroyed meanwhile is invalid.
struct TouchEvent {
  ShapeId shape_a{}, shape_b{};
};

/// Two shapes hit each other hard.
struct HitEvent {
  ShapeId shape_a{}, shape_b{};
  Vec2d point{};       ///< m
  Vec2d normal{};      ///< from a to b
  double speed = 0;    ///< m/s, of approach
  double impulse = 0;  ///< N s, along the normal, of the whole step and all points
};

struct SensorEvent {
  ShapeId sensor{}, visitor{};
};

struct JointEvent {
  JointId joint{};  ///< invalid: the joint has broken
};

/// The load of a joint exceeded its report threshold.
struct JointLoadEvent {
  JointId joint{};
  double force = 0, torque = 0;  ///< N, N m: mean reaction over the step
};

/// Quantity of a body that was not finite or exceeded 1e12. `None`: the program disabled the body.
enum class BadField : std::uint8_t { Force, Torque, Velocity, AngularVelocity, None, Position, Angle };
inline constexpr const char* kBadFieldNames[] = {"force", "torque",   "velocity", "angular_velocity",
                                                 "none",  "position", "angle"};

/// A body was quarantined, because one of its numbers was not finite, or beyond 1e12.
struct QuarantineEvent {
  BodyId body{};
  std::string name{};     ///< from the body's definition
  BadField field{};       ///< returned by a force law, or reached in a step
  double value = 0;       ///< its first invalid component, in SI units
  std::int64_t step = 0;  ///< step that was affected, from 1
};

/// Events of the last step, and of the time between it and the step before. The next step clears them. Every
/// begin has exactly one end. Bodies that repeatedly wake and fall asleep between two steps may be reported
/// once.
struct Events {
  std::vector<TouchEvent> begin, end;
  std::vector<HitEvent> hits;
  std::vector<SensorEvent> sensor_begin, sensor_end;
  std::vector<JointEvent> broken;
  std::vector<JointLoadEvent> loaded;  ///< in each step in which the load exceeds the threshold
  std::vector<BodyId> fell_asleep, woke;
  std::vector<QuarantineEvent> quarantined;

  void clear() {
    begin.clear(), end.clear(), hits.clear(), sensor_begin.clear(), sensor_end.clear(), broken.clear();
    loaded.clear(), fell_asleep.clear(), woke.clear(), quarantined.clear();
  }
};

}  // namespace plumb
