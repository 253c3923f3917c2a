#pragma once

#include <gtest/gtest.h>

#include "engine/world/mover.h"
#include "tests/world/support.h"

namespace plumb {

inline constexpr double kDt = 1.0 / 60;
inline constexpr double kRadius = 0.3, kSkin = 0.006;       // a fiftieth of the radius
inline const Capsule kPerson{{0, 0.3}, {0, 1.5}, kRadius};  // its feet are at the frame's origin

/// A game's use of the mover: gravity, a walking speed, then the world's step.
template <class Real>
class MoverScene : public testing::Test {
 protected:
  // Rotations and corners are rounded to Real; scenes are some 10 m large.
  static constexpr double kTolerance = sizeof(Real) == 4 ? 2e-6 : 1e-9;

  BodyId add_static(const ShapeGeometry& geometry, Vec2d at, double angle = 0) {
    return world.create_body({.type = BodyType::Static, .position = at, .angle = angle},
                             ShapeDefinition{.geometry = geometry, .material = {.friction = 0}});
  }
  void add_floor() { add_static(Box{200, 2}, {0, -1}); }
  BodyId add_platform(Vec2d at, Vec2d speed, double spin = 0, Box box = {4, 1}) {
    return world.create_body(
        {.type = BodyType::Kinematic, .position = at, .velocity = speed, .angular_velocity = spin},
        ShapeDefinition{.geometry = box});
  }
  void place(Vec2d at) { now = {.position = at}; }

  // One frame on the ground or in the air.
  const MoverResult& frame(double speed) {
    if (now.on_ground) now.velocity.x = speed;
    now.velocity.y -= kGravity * kDt;
    now = move(world, kPerson, now.position, now.velocity, kDt, options);
    apply_pushes(world, now);
    world.step(kDt);
    return now;
  }
  // Frames at a speed; true when it stood on the ground after all of them.
  bool walk(int frames, double speed) {
    bool stands = true;
    for (int i = 0; i < frames; ++i) stands = frame(speed).on_ground && stands;
    return stands;
  }

  BasicWorld<Real> world;
  MoverOptions options;
  MoverResult now;
};

}  // namespace plumb
