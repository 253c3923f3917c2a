// Millimetres or kilometres: with gravity in proportion, the same scene does the same at any size.
#include <cstdio>

#include "engine/world/world.h"

// Where the ball of a small scene is after 3 s, in units of the scene's size (m).
plumb::Vec2d play(double size) {
  using namespace plumb;
  World world({.gravity = {0, -9.81 * size}});
  world.create_body({.type = BodyType::Static, .position = {0, -size}},
                    {.geometry = Box{60 * size, 2 * size}, .material = {.restitution = 0.6}});
  for (int i = 0; i < 5; ++i)
    world.create_body({.position = {0, (0.5 + i) * size}}, {.geometry = Box{size, size}});
  const BodyId ball = world.create_body({.position = {-6 * size, 2 * size}, .velocity = {8 * size, 3 * size}},
                                        {.geometry = Circle{0.5 * size}});
  for (int i = 0; i < 180; ++i) world.step();
  return (1 / size) * world.position(ball);
}

int main() {
  const plumb::Vec2d metres = play(1);
  bool same = true;
  for (const double size : {0.0009765625, 1024.0}) {  // powers of two: not even the rounding differs
    const plumb::Vec2d other = play(size);
    same = same && other == metres;
  }
  std::printf("the ball ends at the same place at every size: %s\n", same ? "yes" : "no");
  return same ? 0 : 1;
}
