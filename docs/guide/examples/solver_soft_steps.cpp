// Soft steps, the default: a tower of ten and a heavy box on a light one, for ten seconds.
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world({.sleeping = false, .solver = Solver::SoftSteps});
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{60, 2}});
  BodyId top{};
  for (int i = 0; i < 10; ++i) top = world.create_body({.position = {0, 0.5 + i}}, {.geometry = Box{1, 1}});
  world.create_body({.position = {5, 0.5}}, {.geometry = Box{1, 1}});
  const BodyId heavy = world.create_body({.position = {5, 1.5}}, {.geometry = Box{1, 1}, .density = 500});
  for (int i = 0; i < 600; ++i) world.step(1.0 / 60, 4);
  std::printf("the tower's top is at %.3f m\n", world.position(top).y);
  std::printf("a box of 500 kg on one of 1 kg is at %.3f m\n", world.position(heavy).y);
  return 0;
}
