// A character that runs, climbs a step, jumps onto a lift and rides it.
#include "engine/world/mover.h"

#include <cstdio>

int main() {
  using namespace plumb;
  World world;
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, ShapeDefinition{.geometry = Box{40, 2}});
  world.create_body({.type = BodyType::Static, .position = {4, 0.1}},
                    ShapeDefinition{.geometry = Box{2, 0.2}});
  const BodyId lift =
      world.create_body({.type = BodyType::Kinematic, .position = {9, 0.2}, .velocity = {0, 0.25}},
                        ShapeDefinition{.geometry = Box{4, 0.2}});

  const Capsule person{.start = {0, 0.3}, .end = {0, 1.5}, .radius = 0.3};  // feet at the origin
  const MoverOptions options{.max_slope = 0.8, .step_height = 0.3, .mass = 80, .push_force = 500};
  const double dt = 1.0 / 60, gravity = 9.81, run_speed = 4, jump_speed = 6;
  MoverResult hero{.position = {0, 0.1}};

  for (int frame = 0; frame < 240; ++frame) {
    const bool wants_jump = hero.on_ground && hero.ground != lift && hero.position.x > 6;
    if (hero.on_ground) hero.velocity.x = hero.ground == lift ? 0 : run_speed;
    if (wants_jump) hero.velocity.y = jump_speed;
    hero.velocity.y -= gravity * dt;
    hero = move(world, person, hero.position, hero.velocity, dt, options);
    apply_pushes(world, hero);
    world.step(dt);
  }

  if (hero.ground != lift) return 1;
  std::printf("rides the lift at %.2f, %.2f m, rising at %.2f m/s\n", hero.position.x, hero.position.y,
              hero.ground_velocity.y);
  return 0;
}
