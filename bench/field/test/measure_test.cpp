#include "bench/field/measure.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "bench/field/heap.h"
#include "bench/field/test/still_world.h"

namespace plumb::field {
namespace {

std::vector<const Engine*> present() {
  std::vector<const Engine*> out;
  for (const Engine& engine : engines())
    if (engine.missing.empty()) out.push_back(&engine);
  return out;
}

const Scene& scene_called(const std::string& name) {
  return *std::ranges::find_if(scenes(), [&](const Scene& scene) { return scene.name == name; });
}

/// Every dynamic body sinks by 1 mm a step, and every step allocates three blocks of 1000 bytes and keeps
/// one.
class SinkingWorld final : public StillWorld {
 public:
  BodyHandle create_body(const BodyDefinition& body, std::span<const ShapeDefinition> shapes,
                         const MassProperties& mass) override {
    sinks_.push_back(body.type == BodyType::Dynamic);
    return StillWorld::create_body(body, shapes, mass);
  }
  void step() override {
    ++steps_;
    for (int i = 0; i < 2; ++i) ::operator delete(::operator new(1000));
    kept_[steps_ % 2] = std::make_unique<char[]>(1000);
  }
  BodyState state(BodyHandle body) const override {
    BodyState out = StillWorld::state(body);
    if (sinks_[body.bits]) out.position.y -= 1e-3 * steps_;
    return out;
  }

 private:
  int steps_ = 0;
  std::vector<bool> sinks_;
  std::unique_ptr<char[]> kept_[2];
};

TEST(Measure, FindsWhatIsKnownOfASinkingPyramid) {
  const Engine engine{"sinking", "1", "", [](const WorldSettings&) -> std::unique_ptr<FieldWorld> {
                        return std::make_unique<SinkingWorld>();
                      }};
  Plan plan;
  plan.scenes = {&scene_called("pyramid_10")};
  plan.engines = {&engine};
  plan.repeat = 1;
  plan.steps = 20;
  Measurement m;
  measure(
      plan, [](const Progress&) {}, [&](std::vector<Measurement>& done) { m = done.front(); },
      [] { return false; });
  ASSERT_EQ(m.failure, "");
  // 100 steps of warm-up and 20 measured ones, sampled after every second of these.
  EXPECT_NEAR(*m.height, (9.5 - 0.12) / 9.5, 1e-12);
  EXPECT_NEAR(m.quality.deepest, 0.12, 1e-12);
  EXPECT_NEAR(m.quality.mean_depth, 0.111, 1e-12);
  EXPECT_EQ(m.quality.near, 145);
  EXPECT_NEAR(m.speed.rms, 0.06, 1e-12);
  EXPECT_NEAR(m.speed.max, 0.06, 1e-12);
  ASSERT_EQ(m.step_seconds.size(), 1u);
  EXPECT_GT(m.step_seconds[0], 0);
  EXPECT_EQ(m.allocations_a_step, heap::counted() ? 3 : 0);
}

// Allocations of the builder's own records do not count for the engine.
TEST(Builder, MetersTheEngineAlone) {
  if (!heap::counted()) GTEST_SKIP() << "a sanitizer's allocator is in charge";
  SinkingWorld world;
  Builder builder(world);
  builder.step(10);
  EXPECT_EQ(builder.cost().allocations, 30);
  EXPECT_GE(builder.cost().bytes, 2 * 1000);
  EXPECT_LE(builder.cost().bytes, 2 * 1024);
}

TEST(Measure, TakesTurnsAndFillsEveryFigure) {
  Plan plan;
  plan.scenes = {&scene_called("pyramid_10")};
  plan.engines = present();
  plan.repeat = 3;
  plan.steps = 20;
  std::vector<std::string> order;
  std::vector<Measurement> row;
  measure(
      plan, [&](const Progress& progress) { order.push_back(progress.what); },
      [&](std::vector<Measurement>& done) { row = done; }, [] { return false; });
  const std::size_t n = plan.engines.size();
  ASSERT_EQ(row.size(), n);
  ASSERT_EQ(order.size(), 3 * n);
  for (std::size_t i = 0; i < 3 * n; ++i)
    EXPECT_EQ(order[i], "pyramid_10 on " + plan.engines[(i / n + i % n) % n]->name);
  for (const Measurement& m : row) {
    EXPECT_EQ(m.failure, "");
    EXPECT_EQ(m.step_seconds.size(), 3u);
    EXPECT_EQ(m.asked.bodies, 56);
    ASSERT_TRUE(m.height.has_value());
    EXPECT_NEAR(*m.height, 1, 0.02);
    EXPECT_GT(m.quality.near, 130);
  }
}

/// A world that fails in the second step.
class BrokenWorld : public StillWorld {
 public:
  enum class Way { Dies, Throws, IsNotFinite };
  explicit BrokenWorld(Way way) : way_(way) {}

  void step() override {
    if (++steps_ < 2) return;
    if (way_ == Way::Dies) std::abort();
    if (way_ == Way::Throws) throw std::runtime_error("lost its way");
  }
  BodyState state(BodyHandle body) const override {
    BodyState out = StillWorld::state(body);
    if (way_ == Way::IsNotFinite && steps_ > 1) out.position.x = std::nan("");
    return out;
  }

 private:
  Way way_;
  int steps_ = 0;
};

template <BrokenWorld::Way way>
std::unique_ptr<FieldWorld> broken(const WorldSettings&) {
  return std::make_unique<BrokenWorld>(way);
}

TEST(Measure, AnEngineThatFailsIsAResultAndTheOthersGoOn) {
  const Engine sound{"sound", "1", "", [](const WorldSettings&) -> std::unique_ptr<FieldWorld> {
                       return std::make_unique<StillWorld>();
                     }};
  const Engine dies{"dies", "1", "", broken<BrokenWorld::Way::Dies>};
  const Engine throws{"throws", "1", "", broken<BrokenWorld::Way::Throws>};
  const Engine nan{"nan", "1", "", broken<BrokenWorld::Way::IsNotFinite>};
  Plan plan;
  plan.scenes = {&scene_called("chain_10")};
  plan.engines = {&dies, &throws, &nan, &sound};
  plan.repeat = 2;
  plan.quick = true;
  std::vector<Measurement> row;
  measure(
      plan, [](const Progress&) {}, [&](std::vector<Measurement>& done) { row = done; },
      [] { return false; });
  ASSERT_EQ(row.size(), 4u);
  EXPECT_NE(row[0].failure.find("SIGABRT"), std::string::npos) << row[0].failure;
  EXPECT_EQ(row[1].failure, "lost its way");
  EXPECT_EQ(row[2].failure, "a pose or a velocity is not finite");
  EXPECT_EQ(row[3].failure, "");
  EXPECT_EQ(row[3].step_seconds.size(), 2u);
  EXPECT_EQ(row[3].asked.joints, 10);
}

TEST(Measure, GivesUpWhatTakesTooLong) {
  Plan plan;
  plan.scenes = {&scene_called("junkyard")};
  plan.engines = present();
  plan.repeat = 2;
  plan.quick = true;
  plan.limit = 1e-6;
  std::vector<Measurement> row;
  measure(
      plan, [](const Progress&) {}, [&](std::vector<Measurement>& done) { row = done; },
      [] { return false; });
  for (const Measurement& m : row) {
    EXPECT_EQ(m.failure.rfind("stopped after 1 steps", 0), 0u) << m.failure;
    EXPECT_TRUE(m.step_seconds.empty());
  }
}

TEST(Median, OfOddAndEvenCounts) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(median({}), 0);
}

}  // namespace
}  // namespace plumb::field
