// Sleep and waking, substeps, and a bullet that does not tunnel.
#include <cstdio>
#include <vector>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{400, 2}});
  std::vector<BodyId> tower;
  for (int i = 0; i < 8; ++i)
    tower.push_back(world.create_body({.position = {0, 0.5 + i}}, {.geometry = Box{1, 1}}));

  int steps = 0;
  while (world.counts().awake > 0 && steps < 600) world.step(), ++steps;
  std::printf("asleep after %.2f s, %s\n", steps / 60.0, world.awake(tower[7]) ? "no" : "with the top box");

  world.destroy(tower[0]);  // the support goes: what stood on it wakes
  world.step();
  std::printf("%d of 7 boxes awake\n", world.counts().awake);

  // 1000 m/s is 17 m a step, against a wall of 0.1 m.
  world.create_body({.type = BodyType::Static, .position = {105, 5}}, {.geometry = Box{0.1, 10}});
  const BodyId bullet =
      world.create_body({.position = {60, 5}, .velocity = {1000, 0}}, {.geometry = Circle{0.05}});
  for (int i = 0; i < 10; ++i) world.step(1.0 / 60, 8);  // more substeps: stiffer, and dearer
  std::printf("the bullet is at %.1f m, in front of the wall\n", world.position(bullet).x);
  return world.position(bullet).x < 105 ? 0 : 1;
}
