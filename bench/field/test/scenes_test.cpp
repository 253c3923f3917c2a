#include <algorithm>

#include <gtest/gtest.h>

#include "bench/field/quality.h"
#include "bench/field/scene.h"
#include "bench/field/test/still_world.h"

namespace plumb::field {
namespace {

const Scene& scene_called(const std::string& name) {
  return *std::ranges::find_if(scenes(), [&](const Scene& scene) { return scene.name == name; });
}

/// A full-size scene, after `steps` calls between steps.
struct FullScene {
  StillWorld world;
  Builder builder{world};
  Built built;

  explicit FullScene(const std::string& name, int steps = 0)
      : built(scene_called(name).build(builder, false)) {
    for (int step = 0; step < steps; ++step) built.before_step(builder, step);
  }
  Quality quality() const { return measure_quality(builder.inventory(), builder.states()); }
};

struct Expected {
  const char* name;
  int bodies, shapes, joints;
  int steps = 0;
};

class SceneCounts : public testing::TestWithParam<Expected> {};

// Published counts of the field's own scenes.
TEST_P(SceneCounts, AreTheFields) {
  const FullScene scene(GetParam().name, GetParam().steps);
  const Counts counts = scene.builder.inventory().counts();
  EXPECT_EQ(counts.bodies, GetParam().bodies);
  EXPECT_EQ(counts.shapes, GetParam().shapes);
  EXPECT_EQ(counts.joints, GetParam().joints);
}

INSTANTIATE_TEST_SUITE_P(
    Field, SceneCounts,
    testing::Values(Expected{"large_pyramid", 5051, 5051, 0}, Expected{"many_pyramids", 22001, 22020, 0},
                    Expected{"joint_grid", 10000, 10000, 19800}, Expected{"tumbler", 2027, 2029, 1},
                    Expected{"smash", 9601, 9601, 0}, Expected{"spinner", 6078, 360 + 6077, 1},
                    Expected{"washer", 8102, 8140, 0}, Expected{"rain", 1, 2505, 0},
                    // The 40th column is created at step 312; then each new column replaces one.
                    Expected{"rain", 11001, 2505 + 13000, 10000, 313},
                    Expected{"rain", 11001, 2505 + 13000, 10000, 400}, Expected{"junkyard", 8002, 8262, 0},
                    Expected{"compounds", 3001, 6282, 0}, Expected{"empty", 0, 0, 0},
                    Expected{"one_free_body", 1, 1, 0}, Expected{"chain_10", 11, 10, 10},
                    Expected{"pyramid_10", 56, 56, 0}, Expected{"free_10000", 10000, 10000, 0},
                    Expected{"stacks_10000", 10250, 10250, 0}),
    [](const auto& tested) {
      return std::string(tested.param.name) + "_" + std::to_string(tested.param.steps);
    });

// Neighbours: the ground, two below each square, and those side by side.
TEST(Scenes, PyramidsHaveTheFieldsContacts) {
  EXPECT_EQ(FullScene("large_pyramid").quality().near, 100 + 2 * 4950 + 4950);
  EXPECT_EQ(FullScene("many_pyramids").quality().near, 400 * (10 + 2 * 45 + 45));
  EXPECT_EQ(FullScene("pyramid_10").quality().near, 145);
}

TEST(Scenes, StartWithoutOverlapsWhereTheFieldsDo) {
  for (const char* name : {"large_pyramid", "many_pyramids", "joint_grid", "tumbler", "smash", "washer",
                           "junkyard", "compounds", "chain_10", "free_10000"})
    EXPECT_LT(FullScene(name).quality().deepest, 1e-12) << name;
  EXPECT_EQ(FullScene("free_10000").quality().near, 0);
  EXPECT_EQ(FullScene("joint_grid").quality().near, 0);
}

TEST(Scenes, JointsStartClosed) {
  for (const char* name : {"joint_grid", "tumbler", "spinner", "chain_10"})
    EXPECT_LT(FullScene(name).quality().worst_joint, 1e-13) << name;
  EXPECT_LT(FullScene("rain", 1).quality().worst_joint, 1e-13);
}

TEST(Scenes, NobodyStartsOutside) {
  for (const Scene& scene : scenes()) {
    const FullScene made(scene.name);
    if (!made.built.region) continue;
    for (const BodyState& state : made.builder.states()) {
      EXPECT_GE(state.position.x, made.built.region->low.x) << scene.name;
      EXPECT_LE(state.position.y, made.built.region->high.y) << scene.name;
    }
  }
}

TEST(Scenes, AreNamedOnce) {
  std::vector<std::string> names;
  for (const Scene& scene : scenes()) names.push_back(scene.name);
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

}  // namespace
}  // namespace plumb::field
