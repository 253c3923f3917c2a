#pragma once

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

/// What happened in the last step (and, for the endings, since the one before); the next step empties it.
struct Events {
  std::vector<TouchEvent> begin, end;
  std::vector<HitEvent> hits;
  std::vector<SensorEvent> sensor_begin, sensor_end;
  std::vector<JointEvent> broken;
  std::vector<BodyId> fell_asleep, woke;

  void clear() {
    begin.clear(), end.clear(), hits.clear(), sensor_begin.clear(), sensor_end.clear(), broken.clear();
    fell_asleep.clear(), woke.clear();
  }
};

}  // namespace plumb
