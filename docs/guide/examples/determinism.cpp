// The same calls give the same bits: on this machine, on others, from any compiler.
#include <cstdio>

#include "engine/world/world.h"

plumb::World make() {
  plumb::World world;
  world.create_body({.type = plumb::BodyType::Static}, {.geometry = plumb::Box{40, 1}});
  for (int i = 0; i < 40; ++i) {
    world.create_body({.position = {0.37 * (i % 7), 2 + 0.9 * i}, .angle = 0.3 * i},
                      {.geometry = plumb::Box{0.8, 0.5 + 0.01 * i}});
  }
  return world;
}

int main() {
  plumb::World here = make(), there = make();
  for (int i = 0; i < 300; ++i) {
    here.step();
    there.step();
    if (here.hash() != there.hash()) {
      std::printf("parted in step %d\n", i);
      return 1;
    }
  }
  there.apply_impulse(there.bodies()[1], {1e-3, 0});
  there.step(), here.step();
  std::printf("300 steps with equal hashes; after a nudge of 1 mN s: %s\n",
              here.hash() == there.hash() ? "equal" : "different");
  return here.hash() == there.hash() ? 1 : 0;
}
