// A saved game: the world as bytes, and the same future afterwards.
#include <cstddef>
#include <cstdio>
#include <vector>

#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"

int main() {
  plumb::World world;
  world.create_body({.type = plumb::BodyType::Static}, {.geometry = plumb::Box{20, 1}});
  std::vector<plumb::BodyId> boxes;
  for (int i = 0; i < 10; ++i)
    boxes.push_back(
        world.create_body({.position = {0.1 * i, 1.5 + 1.2 * i}}, {.geometry = plumb::Box{1, 1}}));
  for (int i = 0; i < 60; ++i) world.step();

  const std::vector<std::byte> saved = plumb::save(world);
  world.destroy(boxes[3]);
  for (int i = 0; i < 120; ++i) world.step();

  plumb::restore(world, saved);  // the box is back, and its handle is valid again
  plumb::World other;
  plumb::restore(other, saved);  // on another machine, say
  for (int i = 0; i < 120; ++i) world.step(), other.step();

  const bool same = plumb::full_hash(world) == plumb::full_hash(other);
  std::printf("%zu bytes, box 3 %s, the same future: %s\n", saved.size(),
              world.valid(boxes[3]) ? "is back" : "is gone", same ? "yes" : "no");
  return same && world.valid(boxes[3]) ? 0 : 1;
}
