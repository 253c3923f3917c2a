// A step shared by threads: of the world's own, and of a game's job system. The bits are the same.
#include <cstdio>
#include <thread>
#include <vector>

#include "engine/world/world.h"

std::vector<std::thread> jobs;  // the least job system: a thread for each task

void* start(void*, plumb::TaskSystem::Task task, void* data, int count) {
  for (int i = 0; i < count; ++i) jobs.emplace_back(task, data, i);
  return nullptr;  // or what `finish` needs
}

void finish(void*, void*) {
  for (std::thread& job : jobs) job.join();
  jobs.clear();
}

void play(plumb::World& world) {
  world.create_body({.type = plumb::BodyType::Static, .position = {0, -1}}, {.geometry = plumb::Box{400, 2}});
  for (int i = 0; i < 1000; ++i) {
    world.create_body({.position = {0.7 * (i % 50) + 0.1 * (i / 50), 0.5 + 0.6 * (i / 50)}},
                      {.geometry = plumb::Box{0.5, 0.5}});
  }
  for (int i = 0; i < 60; ++i) world.step();
}

int main() {
  plumb::World alone, pooled({.threads = 2}), hosted({.threads = 3});
  hosted.set_task_system({.start = start, .finish = finish});
  for (plumb::World* world : {&alone, &pooled, &hosted}) play(*world);
  const bool same = pooled.hash() == alone.hash() && hosted.hash() == alone.hash();
  std::printf("%d, %d and %d threads: %s hashes\n", alone.threads(), pooled.threads(), hosted.threads(),
              same ? "equal" : "different");
  return same ? 0 : 1;
}
