// A box falls on the ground and comes to rest.
#include <cstdio>

#include "engine/world/world.h"

int main() {
  plumb::World world;  // gravity 9.81 m/s^2 downwards
  world.create_body({.type = plumb::BodyType::Static, .position = {0, -1}}, {.geometry = plumb::Box{40, 2}});
  const plumb::BodyId box = world.create_body({.position = {0, 4}}, {.geometry = plumb::Box{1, 1}});
  for (int frame = 0; frame < 120; ++frame) world.step(1.0 / 60);
  std::printf("after %.1f s the box is at %.2f m\n", world.time(), world.position(box).y);
  return 0;
}
