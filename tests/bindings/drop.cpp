// The program of bindings/*/examples/drop, in C++: what it prints is what the others must print.
#include <cinttypes>
#include <cstdio>

#include "engine/world/queries.h"
#include "engine/world/snapshot.h"
#include "engine/world/world.h"

int main() {
  const auto step = [](plumb::World& world, int count) {
    for (int i = 0; i < count; ++i) world.step(1.0 / 60, 4);
  };
  plumb::World world;
  world.create_body({.type = plumb::BodyType::Static, .position = {0, -1}}, {.geometry = plumb::Box{40, 2}});
  const plumb::BodyId box =
      world.create_body({.position = {0, 4}, .angle = 0.3}, {.geometry = plumb::Box{1, 1}});
  step(world, 60);

  if (const auto hit = plumb::ray_cast_closest(world, {0, 10}, {0, -20}))
    std::printf("the ray hits at %.6f m\n", hit->point.y);

  const std::vector<std::byte> saved = plumb::save(world);
  step(world, 60);
  const std::uint64_t hash = world.hash();
  std::printf("the box is at %.6f m, hash %016" PRIx64 "\n", world.position(box).y, hash);

  plumb::restore(world, saved);
  step(world, 60);
  std::printf("restored: %s\n", world.hash() == hash ? "the same hash" : "another hash");
  return 0;
}
