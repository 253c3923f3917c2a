// Heavy on light: a box on one of a thousandth of its mass, and a chain with a tip of a thousand links.
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{60, 2}});
  const BodyId light = world.create_body({.position = {-5, 0.5}}, {.geometry = Box{1, 1}, .density = 1});
  const BodyId heavy = world.create_body({.position = {-5, 1.5}}, {.geometry = Box{1, 1}, .density = 1000});

  BodyId last = world.create_body({.type = BodyType::Static, .position = {5, 12}});
  const BodyId hook = last;
  for (int i = 0; i < 10; ++i) {
    const double density = i == 9 ? 4000 : 4;  // links of 1 kg, and a tip of 1000 kg
    const BodyId link = world.create_body({.position = {5, 11.5 - i}, .may_sleep = false},
                                          {.geometry = Box{0.25, 1}, .density = density});
    world.create_joint(
        last, link,
        {.kind = RevoluteDefinition{.anchor_a = {0, last == hook ? 0 : -0.5}, .anchor_b = {0, 0.5}}});
    last = link;
  }
  for (int i = 0; i < 600; ++i) world.step();
  const double stretch = 2.5 - world.position(last).y;
  const double sunk = 1.5 - world.position(heavy).y;
  std::printf("light box at %.3f m, the heavy one sank by less than 1 mm: %s\n", world.position(light).y,
              sunk < 1e-3 ? "yes" : "no");
  std::printf("the chain of 10 m stretched by less than 1 mm: %s\n", stretch < 1e-3 ? "yes" : "no");
  return sunk < 1e-3 && stretch < 1e-3 ? 0 : 1;
}
