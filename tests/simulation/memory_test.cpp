// Steps for which there is not enough memory.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "engine/scene/error.h"
#include "tests/simulation/scenes.h"

// Sanitizers have an allocator of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
namespace {

long left = -1;  // allocations before one fails (others do not); below zero: none does

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  void* const memory = left == 0 ? nullptr : std::malloc(size > 0 ? size : 1);
  if (left >= 0) --left;
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#endif

namespace plumb {
namespace {

using namespace plumb::testing;

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// Counts runs that failed, each for want of another allocation of step `step`.
int failures(const Scene& scene, const Accuracy& accuracy, int step) {
  int failed = 0;
  for (const int allocation : {0, 1, 2, 4, 8, 15, 30, 60}) {
    Simulation world = compile(scene, accuracy);
    world.step(step);
    const double before = world.time();
    left = allocation;
    std::string subject, field;
    try {
      world.step();
      left = -1;
    } catch (const Error& error) {
      left = -1;
      subject = error.subject(), field = error.field();
    }
    if (field.empty()) continue;
    ++failed;
    EXPECT_EQ(subject, "simulation");
    EXPECT_EQ(field, "memory");
    // It is not finished, and nothing goes on from its middle.
    EXPECT_EQ(world.time(), before);
    EXPECT_THROW(world.step(), Error);
    EXPECT_EQ(world.time(), before);
  }
  return failed;
}
#endif

TEST(Memory, AStepThatHasTooLittleIsAnErrorAndTheLastOne) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer has an allocator of its own";
#else
  Scene scene = with(empty_scene(), {plane()});
  for (int i = 0; i < 4; ++i)
    scene.bodies.push_back(disc("disc " + std::to_string(i), {0.1 * i, 0.6 + 1.1 * i}));
  int realtime = 0, precise = 0;
  for (const int step : {0, 3, 9, 23, 39}) {
    realtime += failures(scene, Realtime{}, step);
    precise += failures(scene, Precise{}, step);
  }
  EXPECT_GE(realtime, 2);
  EXPECT_GE(precise, 10);
#endif
}

}  // namespace
}  // namespace plumb
