// A step shared by threads: of the world's own, and of a game's job system. The bits are the same.
#include <cstdio>
#include <thread>
#include <vector>

#include "engine/world/world.h"

// The least job system: a thread for each task. A game hands its tasks to the threads that it has.
struct Jobs {
  std::vector<std::thread> running;

  plumb::TaskSystem tasks() {
    return {.start =
                [](void* user, plumb::TaskSystem::Task task, void* data, int count) -> void* {
                  Jobs& jobs = *static_cast<Jobs*>(user);
                  for (int i = 0; i < count; ++i) jobs.running.emplace_back(task, data, i);
                  return nullptr;
                },
            .finish =
                [](void* user, void*) {
                  Jobs& jobs = *static_cast<Jobs*>(user);
                  for (std::thread& job : jobs.running) job.join();
                  jobs.running.clear();
                },
            .user = this};
  }
};

void fill(plumb::World& world) {
  world.create_body({.type = plumb::BodyType::Static, .position = {0, -1}}, {.geometry = plumb::Box{400, 2}});
  for (int i = 0; i < 1000; ++i) {
    world.create_body({.position = {0.7 * (i % 50) + 0.1 * (i / 50), 0.5 + 0.6 * (i / 50)}},
                      {.geometry = plumb::Box{0.5, 0.5}});
  }
}

int main() {
  plumb::World alone, pooled({.threads = 2}), hosted({.threads = 3});
  Jobs jobs;  // outlives the steps
  hosted.set_task_system(jobs.tasks());
  for (plumb::World* world : {&alone, &pooled, &hosted}) {
    fill(*world);
    for (int i = 0; i < 60; ++i) world->step();
  }
  const bool same = pooled.hash() == alone.hash() && hosted.hash() == alone.hash();
  std::printf("%d, %d and %d threads: %s hashes\n", alone.threads(), pooled.threads(), hosted.threads(),
              same ? "equal" : "different");
  return same ? 0 : 1;
}
