// Kinds of bodies, forces and impulses, damping, gravity scale and locked axes.
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  const ShapeDefinition crate{.geometry = Box{1, 1}, .density = 2};  // 2 kg
  world.create_body({.name = "ground", .type = BodyType::Static}, {.geometry = Box{100, 2}});
  const BodyId lift = world.create_body({.type = BodyType::Kinematic, .position = {-20, 5}}, crate);
  const BodyId rocket = world.create_body({.position = {-10, 5}, .may_sleep = false}, crate);
  const BodyId balloon = world.create_body({.position = {0, 5}, .gravity_scale = -0.1}, crate);
  const BodyId feather = world.create_body({.position = {10, 5}, .linear_damping = 8}, crate);
  const BodyId bead = world.create_body(
      {.position = {20, 5}, .velocity = {1, 0}, .lock_y = true, .lock_rotation = true}, crate);

  const double dt = 1.0 / 60;
  for (int frame = 0; frame < 60; ++frame) {
    world.move_towards(lift, {-20, 5 + 0.05 * frame}, 0, dt);         // where it is at the end of the step
    world.apply_force(rocket, {0, world.mass(rocket) * (9.81 + 2)});  // through this step alone
    world.step(dt);
  }
  world.apply_impulse(rocket, {4, 0});  // 4 N s on 2 kg: 2 m/s at once

  std::printf("lift %.2f m, rocket %.2f m at %.2f m/s and %.2f m/s across\n", world.position(lift).y,
              world.position(rocket).y, world.velocity(rocket).y, world.velocity(rocket).x);
  std::printf("balloon %.2f m, feather falls at %.2f m/s, bead at %.2f, %.2f m\n", world.position(balloon).y,
              -world.velocity(feather).y, world.position(bead).x, world.position(bead).y);
  return 0;
}
