#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "engine/scene/error.h"
#include "engine/world/rollback.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "tests/world/allocations.h"
#include "tests/world/support.h"
#include "tests/world/threadings.h"

// A step that several threads share has the bits of a step of one, in whatever order its blocks are run.
namespace plumb {
namespace {

template <class Real>
class Threads : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Threads, Precisions);

// A room into which bodies of all kinds fall, more than fit into a block of any loop: with restitution,
// rolling, joints of several kinds, heavy on light, small and fast, and a paddle that comes down and turns.
template <class Real>
void fill_room(BasicWorld<Real>& world, int count, double speed = 60) {
  std::mt19937 from(11);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(from()) * 0x1p-32);
  };
  const BodyId room = world.create_body({.type = BodyType::Static});
  world.create_shape(room, {.geometry = Box{60, 1}, .position = {0, -0.5}});
  world.create_shape(room, {.geometry = Box{1, 60}, .position = {-11, 30}});
  world.create_shape(room, {.geometry = Box{1, 60}, .position = {11, 30}});
  world.create_body(
      {.type = BodyType::Kinematic, .position = {0, 11}, .velocity = {0, -6}, .angular_velocity = 3},
      ShapeDefinition{.geometry = Box{8, 0.3}});
  BodyId last = room;
  for (int i = 0; i < count; ++i) {
    const double size = between(0.2, 0.5);
    const ShapeGeometry kinds[] = {
        Circle{size / 2}, Box{size, size}, Capsule{{-size / 3, 0}, {size / 3, 0}, size / 4},
        Polygon{{{-size / 2, -size / 3}, {size / 2, -size / 3}, {0, size / 2}}, 0.02}};
    const ShapeDefinition shape{.geometry = kinds[i % 4],
                                .density = i % 9 == 0 ? 20.0 : 1.0,
                                .material = {.friction = between(0, 1),
                                             .restitution = i % 13 == 0 ? 0.4 : 0.0,
                                             .rolling_resistance = i % 3 == 0 ? 0.05 : 0.0}};
    const BodyId body = world.create_body({.position = {-9.5 + 0.6 * (i % 32), 0.5 + 0.6 * (i / 32)},
                                           .angle = between(0, 6),
                                           .velocity = {0, i % 17 == 0 ? -speed : -2.0}},
                                          shape);
    if (i % 5 == 4)
      world.create_joint(last, body, {.kind = DistanceDefinition{.length = 0.7, .spring = Spring{4, 0.5}}});
    if (i % 7 == 6)
      world.create_joint(last, body,
                         {.kind = RevoluteDefinition{
                              .anchor_a = {0.3, 0}, .anchor_b = {-0.3, 0}, .limits = Range{-0.5, 0.5}}});
    last = body;
  }
}

// Bodies in a room, more than a block of any loop has, and steps.
constexpr int kBodies = test::kThreadSanitizer ? 160 : 300, kSteps = test::kThreadSanitizer ? 8 : 20;

template <class Real, class Set>
std::vector<std::uint64_t> hashes_of_room(const Set& set, const WorldDefinition& definition = {}) {
  BasicWorld<Real> world(definition);
  set(world);
  fill_room(world, kBodies);
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < kSteps; ++i) {
    world.step(1.0 / 60, 4);
    if (i % 4 == 3) hashes.push_back(full_hash(world));
  }
  return hashes;
}

TYPED_TEST(Threads, HeapsHaveTheSameBitsForEachNumberAndOrder) {
  using Real = TypeParam;
  const auto alone = hashes_of_room<Real>([](BasicWorld<Real>&) {});
  test::at_each_threading<Real>([&](const auto& set) { EXPECT_EQ(hashes_of_room<Real>(set), alone); });
}

TYPED_TEST(Threads, EachSolverHasTheSameBitsForEachNumber) {
  using Real = TypeParam;
  for (const Solver solver : {Solver::Direct, Solver::SequentialImpulses, Solver::Jakobsen, Solver::Xpbd}) {
    SCOPED_TRACE(name_of(solver));
    const WorldDefinition definition{.continuous = solver != Solver::Xpbd, .solver = solver};
    const auto run_room = [&](int threads) {
      BasicWorld<Real> world(definition);
      if (threads > 1) test::share_all(world, threads, LoopOrder::Shuffled);
      fill_room(world, test::kThreadSanitizer ? 160 : 200);
      run(world, 2 * kSteps);
      return full_hash(world);
    };
    const std::uint64_t alone = run_room(1);
    for (const int threads : {2, 3}) EXPECT_EQ(run_room(threads), alone) << threads << " threads";
  }
}

// Joints pass on what is no number when bodies run away, and quarantine clears it: its sign would depend on
// how many joints were solved side by side. Without that the hashes part after 15 and 8 steps.
TYPED_TEST(Threads, RunawaysHaveTheSameBits) {
  using Real = TypeParam;
  for (const double speed : {1e10, 8e11}) {
    const auto hashes = [&](int threads) {
      BasicWorld<Real> world({.integrator = Integrator::SemiImplicitEuler});  // solves joints by iterations
      if (threads > 1) test::share_all(world, threads, LoopOrder::Shuffled);
      fill_room(world, kBodies, speed);
      std::vector<std::uint64_t> all;
      for (int i = 0; i < 17; ++i) {
        world.step();
        all.push_back(full_hash(world));
      }
      EXPECT_GT(world.quarantined().size(), 0u);
      return all;
    };
    EXPECT_EQ(hashes(3), hashes(1)) << speed;
  }
}

// Nets of hinges, and ragdolls with limits, in colours of more joints than a thread takes at a time.
TYPED_TEST(Threads, JointsHaveTheSameBitsForEachNumberAndOrder) {
  using Real = TypeParam;
  const auto hash_of = [](const auto& set) {
    BasicWorld<Real> world({.sleeping = false});
    set(world);
    constexpr int kSide = 24;
    std::vector<BodyId> net;
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec2d at{static_cast<double>(i % kSide), -static_cast<double>(i / kSide)};
      net.push_back(world.create_body(
          {.type = i < kSide && i % 6 == 0 ? BodyType::Static : BodyType::Dynamic, .position = at},
          ShapeDefinition{.geometry = Circle{0.4}, .filter = {.mask = 0}}));
      const auto tie = [&](BodyId other, Vec2d half) {
        world.create_joint(other, net.back(),
                           {.kind = RevoluteDefinition{.anchor_a = half, .anchor_b = -half}});
      };
      const auto gives_way = [&](BodyId body) { return world.type(body) == BodyType::Dynamic; };
      if (i % kSide > 0 && (gives_way(net[i]) || gives_way(net[i - 1]))) tie(net[i - 1], {0.5, 0});
      if (i >= kSide) tie(net[i - kSide], {0, -0.5});
    }
    // Puppets of four parts, whose joints have limits and springs.
    for (int i = 0; i < 240; ++i) {
      const BodyId part = add_box(world, {40 + 0.8 * i, 1.0 + 0.1 * (i % 3)}, 2, 0.6, 0.3);
      if (i % 4 > 0) {
        world.create_joint(net.back(), part,
                           {.kind = RevoluteDefinition{.anchor_a = {0.4, 0},
                                                       .anchor_b = {-0.4, 0},
                                                       .limits = Range{-0.4, 0.3},
                                                       .spring = Spring{5, 0.5}}});
      }
      net.push_back(part);
    }
    world.create_body({.type = BodyType::Static},
                      ShapeDefinition{.geometry = Box{400, 1}, .position = {140, -0.5}});
    run(world, 2 * kSteps);
    return full_hash(world);
  };
  const std::uint64_t alone = hash_of([](BasicWorld<Real>&) {});
  test::at_each_threading<Real>([&](const auto& set) { EXPECT_EQ(hash_of(set), alone); });
}

TYPED_TEST(Threads, StepsDoNotAllocateOnceWarm) {
  using Real = TypeParam;
  for (const int threads : {2, 3}) {
    BasicWorld<Real> world({.sleeping = false, .threads = threads});
    add_ground(world);
    for (int row = 0; row < 30; ++row)
      for (int i = 0; i < 30 - row; ++i) add_box(world, {i + 0.5 * row, 0.5 + row});
    run(world, 60);
    const long before = test::allocations();
    run(world, 60);
    EXPECT_EQ(test::allocations() - before, 0) << threads << " threads";
  }
}

// A game's thread may round in a way of its own; the threads of a pool do not start so.
TEST(ThreadCounts, DoNotChangeHowTheCallerRounds) {
  struct Rounding {
    explicit Rounding(int mode) { std::fesetround(mode); }
    ~Rounding() { std::fesetround(FE_TONEAREST); }
  };
  const auto hash_of = [](int threads, int mode) {
    World world;
    test::share_all(world, threads);
    fill_room(world, kBodies);
    const Rounding rounding(mode);
    run(world, kSteps);
    EXPECT_EQ(std::fegetround(), mode);
    return full_hash(world);
  };
  EXPECT_NE(hash_of(1, FE_DOWNWARD), hash_of(1, FE_TONEAREST));
  EXPECT_EQ(hash_of(3, FE_DOWNWARD), hash_of(1, FE_DOWNWARD));
}

TEST(ThreadCounts, OutOfRangeAreRefused) {
  World world;
  for (const int bad : {-1, 0, 65, 10000}) {
    for (const bool later : {false, true}) {
      try {
        later ? world.set_threads(bad) : static_cast<void>(World({.threads = bad}));
        ADD_FAILURE() << bad << " threads were accepted";
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), Error::Kind::Value);
        EXPECT_EQ(error.field(), "threads");
        EXPECT_EQ(error.value(), std::to_string(bad));
      }
    }
  }
  EXPECT_EQ(world.threads(), kUsualThreads);
  world.set_threads(64);
  EXPECT_EQ(world.threads(), 64);
}

TEST(ThreadCounts, AreNotPartOfSnapshots) {
  World one, two({.threads = 2});
  fill_room(one, kBodies), fill_room(two, kBodies);
  run(one, kSteps), run(two, kSteps);
  EXPECT_EQ(save(one), save(two));
  World three({.threads = 3});
  restore(three, save(two));
  EXPECT_EQ(three.threads(), 3);
  run(one, kSteps), run(three, kSteps);
  EXPECT_EQ(full_hash(one), full_hash(three));
  Rollback<float> rollback(three, 2);
  rollback.save();
  three.set_threads(2);
  rollback.back_to(three.step_count());
  EXPECT_EQ(three.threads(), 2);
}

TEST(TaskSystems, OfWhichAHalfIsMissingAreRefused) {
  World world({.threads = 2});
  try {
    world.set_task_system({.finish = [](void*, void*) {}});
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
    EXPECT_EQ(error.field(), "start");
  }
  run(world, 2);
}

TEST(TaskSystems, RunNothingOfOneThreadOrOfASmallWorld) {
  if (kUsualThreads > 1) GTEST_SKIP() << "all loops of this build are shared";
  test::OddTasks tasks(test::OddTasks::AllElsewhere);
  World world({.threads = 2});
  world.set_task_system(tasks.system());
  add_ground(world);
  for (int i = 0; i < 10; ++i) add_box(world, {0, 0.5 + i});
  run(world, 5);
  EXPECT_EQ(tasks.rounds, 0);
  fill_room(world, 400);
  run(world, 1);
  EXPECT_GT(tasks.rounds, 0);
  EXPECT_EQ(tasks.tasks, tasks.rounds) << "one task beside the calling thread";
  const int before = tasks.rounds;
  world.set_threads(1);
  run(world, 1);
  EXPECT_EQ(tasks.rounds, before);
  world.set_threads(3);
  run(world, 1);
  EXPECT_GT(tasks.rounds, before) << "the job system is kept";
  world.set_task_system({});
  const int last = tasks.rounds;
  run(world, 1);
  EXPECT_EQ(tasks.rounds, last);
}

// The user's code runs on the thread that calls `step`, in the same order as with one thread.
TEST(ThreadHooks, AreCalledOnTheCallingThreadInTheSameOrder) {
  const auto calls_of = [](int threads) {
    World world;
    if (threads > 1) test::share_all(world, threads, LoopOrder::Shuffled);
    add_ground(world);
    for (int i = 0; i < 400; ++i) {
      add_body(world, {1.1 * (i % 40), 0.6 + 1.1 * (i / 40)},
               {.geometry = Box{1, 1}, .pre_solve = i % 3 == 0});
    }
    std::vector<std::uint32_t> order;
    world.on_pre_solve([&, caller = std::this_thread::get_id()](const ContactReading& contact) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      order.push_back(contact.shape_a.index), order.push_back(contact.shape_b.index);
      return order.size() % 10 != 0;
    });
    run(world, 30);
    order.push_back(static_cast<std::uint32_t>(world.hash()));
    return order;
  };
  const auto alone = calls_of(1);
  EXPECT_GT(alone.size(), 1000u);
  EXPECT_EQ(calls_of(2), alone);
  EXPECT_EQ(calls_of(3), alone);
}

std::thread::id rule_caller;
int rule_calls = 0;
double harmonic(double a, double b) {
  EXPECT_EQ(std::this_thread::get_id(), rule_caller);
  ++rule_calls;
  return a + b > 0 ? 2 * a * b / (a + b) : 0;
}

TEST(ThreadHooks, CombineRulesAreCalledOnTheCallingThread) {
  rule_caller = std::this_thread::get_id();
  std::uint64_t first = 0;
  for (const int threads : {1, 2, 3}) {
    rule_calls = 0;
    World world({.threads = threads});
    world.combine_with(harmonic, harmonic);
    fill_room(world, 400);
    run(world, 30);
    EXPECT_GT(rule_calls, 400);
    if (first == 0) first = full_hash(world);
    EXPECT_EQ(full_hash(world), first) << threads << " threads";
  }
}

TEST(ThreadHooks, WhatTheyThrowReachesTheCallerAndTheWorldGoesOn) {
  std::uint64_t first = 0;
  for (const int threads : {1, 2, 3}) {
    World world;
    if (threads > 1) test::share_all(world, threads, LoopOrder::Descending);
    add_ground(world);
    for (int i = 0; i < 300; ++i)
      add_body(world, {1.1 * (i % 30), 0.6 + 1.1 * (i / 30)}, {.geometry = Box{1, 1}, .pre_solve = true});
    int calls = 0;
    world.on_pre_solve([&](const ContactReading&) {
      if (++calls % 499 == 0) throw std::runtime_error("enough");
      return true;
    });
    int thrown = 0;
    for (int i = 0; i < 30; ++i) {
      try {
        world.step();
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "enough");
        ++thrown;
      }
    }
    EXPECT_GT(thrown, 2);
    if (first == 0) first = full_hash(world);
    EXPECT_EQ(full_hash(world), first) << threads << " threads";
  }
}

// Memory that runs out in any block of a loop is reported by the call, and nothing is lost.
TEST(ThreadErrors, MemoryThatRunsOutReachesTheCaller) {
  int thrown = 0;
  for (long after = 0; after < 60; after += 3) {
    World world;
    test::share_all(world, 3);
    fill_room(world, kBodies);
    test::fail_after(after);
    try {
      run(world, 12);
    } catch (const std::bad_alloc&) {
      ++thrown;
    }
    test::fail_after(-1);
    run(world, 10);
    for (const BodyId body : world.bodies()) {
      const Vec2d at = world.position(body);
      ASSERT_TRUE(std::isfinite(at.x) && std::isfinite(at.y)) << "after " << after;
    }
  }
  EXPECT_GT(thrown, 10);
}

TEST(LoopSchedulers, RethrowWhatTheFirstBlockThrewAndRunTheOthers) {
  for (const LoopOrder order : {LoopOrder::Ascending, LoopOrder::Descending}) {
    LoopScheduler scheduler;
    scheduler.set_threads(3);
    scheduler.set_eager(true), scheduler.set_order(order);
    std::atomic<int> run = 0;
    for (int round = 0; round < 200; ++round) {
      run = 0;
      try {
        scheduler.blocks(100, [&](int block) {
          ++run;
          if (block % 7 == 3) throw block;
        });
        ADD_FAILURE() << "nothing was thrown";
      } catch (int block) {
        EXPECT_EQ(block, 3);
      }
      EXPECT_EQ(run, 100);
    }
  }
}

TEST(LoopSchedulers, RunEachBlockOnceForAllCountsAndOrders) {
  for (const LoopOrder order : {LoopOrder::Ascending, LoopOrder::Descending, LoopOrder::Shuffled}) {
    for (const int threads : {1, 2, 3, 8}) {
      LoopScheduler scheduler;
      scheduler.set_threads(threads);
      scheduler.set_eager(true), scheduler.set_order(order);
      for (int count = 0; count < 70; ++count) {
        std::vector<std::atomic<int>> times(70);
        scheduler.session([&] {
          scheduler.blocks(count, [&](int block) { ++times[block]; });
          scheduler.ranges(count, 4, [&](int first, int last) {
            for (int i = first; i < last; ++i) ++times[i];
          });
        });
        for (int i = 0; i < 70; ++i) ASSERT_EQ(times[i], i < count ? 2 : 0) << i << " of " << count;
      }
    }
  }
}

// Worlds with pools of their own, each stepped by a thread of its own.
TEST(ManyWorlds, SteppedOnManyThreadsAtOnceStayIndependent) {
  World alone;
  fill_room(alone, kBodies);
  run(alone, 2 * kSteps);
  constexpr int kWorlds = test::kThreadSanitizer ? 3 : 6;
  std::vector<std::uint64_t> hashes(kWorlds);
  std::vector<std::thread> players;
  for (int i = 0; i < kWorlds; ++i) {
    players.emplace_back([&hashes, i] {
      World world({.threads = 1 + i % 3});
      fill_room(world, kBodies);
      run(world, 2 * kSteps);
      hashes[i] = full_hash(world);
    });
  }
  for (std::thread& player : players) player.join();
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, full_hash(alone));
}

}  // namespace
}  // namespace plumb
