// A weld that yields, a mouse that drags, a motor that follows a target, and friction seen from above.
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world({.gravity = {0, 0}});  // seen from above
  const BodyId floor = world.create_body({.type = BodyType::Static});
  const ShapeDefinition crate{.geometry = Box{1, 1}};  // 1 kg

  const BodyId board = world.create_body({.position = {0.5, 0}}, crate);
  world.create_joint(floor, board,
                     {.kind = WeldDefinition{.anchor_b = {-0.5, 0}, .angular_spring = Spring{2, 0.3}}});
  world.apply_angular_impulse(board, 1);

  const BodyId dragged = world.create_body({.position = {5, 0}}, crate);
  const JointId mouse =
      world.create_joint(floor, dragged, {.kind = MouseDefinition{.target = {5, 0}, .max_force = 100}});
  world.change(mouse, MouseDefinition{.target = {5, 3}, .max_force = 100});  // the cursor has moved

  const BodyId follower = world.create_body({.position = {10, 0}}, crate);
  world.create_joint(floor, follower,
                     {.kind = MotorDefinition{
                          .target_position = {10, 2}, .target_angle = 1, .max_force = 50, .max_torque = 20}});

  const BodyId puck = world.create_body({.position = {15, 0}, .velocity = {6, 0}}, crate);
  world.create_joint(floor, puck,
                     {.kind = FrictionDefinition{.anchor_a = {15, 0}, .max_force = 4, .max_torque = 1}});

  for (int i = 0; i < 180; ++i) world.step();
  std::printf("board back at %.2f rad, dragged to %.2f m, follower at %.2f m and %.2f rad\n",
              world.angle(board), world.position(dragged).y, world.position(follower).y,
              world.angle(follower));
  std::printf("the puck slid %.2f m\n", world.position(puck).x - 15);  // v^2 / (2 F / m) = 4.5 m
  return 0;
}
