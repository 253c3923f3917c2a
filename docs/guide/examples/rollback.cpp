// Network play: an input of the other player arrives five steps late.
#include <cstdint>
#include <cstdio>
#include <map>

#include "engine/world/rollback.h"

int main() {
  plumb::World world;
  world.create_body({.type = plumb::BodyType::Static}, {.geometry = plumb::Box{40, 1}});
  const plumb::BodyId car = world.create_body({.position = {0, 1}}, {.geometry = plumb::Box{2, 1}});
  plumb::Rollback<float> rollback(world, 16);
  std::map<std::int64_t, double> pushes;  // by step, as far as they are known

  const auto advance_to = [&](std::int64_t step) {
    while (world.step_count() < step) {
      rollback.save();
      if (const auto push = pushes.find(world.step_count()); push != pushes.end())
        world.apply_impulse(car, {push->second, 0});
      world.step();
    }
  };
  advance_to(60);
  const double guessed = world.position(car).x;
  pushes[55] = 4;  // N s: it happened five steps ago
  rollback.back_to(55);
  advance_to(60);

  std::printf("the car was thought at %.3f m and is at %.3f m\n", guessed, world.position(car).x);
  return world.position(car).x > guessed ? 0 : 1;
}
