// A step allocates nothing once the world has seen its largest crowd.
#include <cstdio>
#include <cstdlib>
#include <new>

#include "engine/world/world.h"

static long allocations = 0;

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

int main() {
  plumb::World world({.sleeping = false});
  world.create_body({.type = plumb::BodyType::Static}, {.geometry = plumb::Box{40, 1}});
  for (int i = 0; i < 100; ++i)
    world.create_body({.position = {1.1 * (i % 10) - 5, 1 + 1.1 * (i / 10)}}, {.geometry = plumb::Box{1, 1}});
  for (int i = 0; i < 120; ++i) world.step();

  const long before = allocations;
  for (int i = 0; i < 120; ++i) world.step();
  std::printf("120 steps with %d contacts made %ld allocations\n", world.counts().touching,
              allocations - before);
  return allocations == before ? 0 : 1;
}
