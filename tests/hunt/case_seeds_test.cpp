// Case files as the seeds of a hunt.
#include "harness/hunt/case_seeds.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "harness/hunt/examine.h"

namespace plumb::harness::hunt {
namespace {

/// A ball on a spring, of which a place at 1 s is expected.
struct CaseFile {
  std::string path = std::filesystem::temp_directory_path() /
                     ("plumb_hunted_" + std::to_string(getpid()) + "_" + std::to_string(count++) + ".json");

  explicit CaseFile(const char* expected) {
    std::ofstream(path) << R"({"plumb_case": 1, "source": "Hooke", "duration": 1, "expect": [)" << expected
                        << R"(],
      "scene": {"gravity": [0, 0], "bodies": [{"name": "ball", "position": [1.5, 0], "mass": 2,
        "shapes": [{"type": "circle", "radius": 0.1}]}],
        "forces": [{"type": "spring", "body_a": "world", "body_b": "ball", "rest_length": 1, "stiffness": 50}]}})";
  }
  ~CaseFile() { std::filesystem::remove(path); }
  static inline int count = 0;
};

// 1 + 0.5 cos(5 t), at t = 1.
constexpr const char* kRight = R"({"of": "ball.x", "is": 1.1418311, "tolerance": 0.05, "at": 1})";
constexpr const char* kWrong =
    R"({"of": "ball.x", "is": 1.5, "tolerance": 0.05, "at": 1, "name": "far away"})";

TEST(CaseSeeds, TheFirstCaseIsTheFilesOwnAndOthersVaryIt) {
  const CaseFile file(kRight);
  const std::vector<CaseSeed> seeds{read_seed(file.path)};
  EXPECT_EQ(vary(1, 0, seeds).scene, seeds.front().scene);
  int changed = 0, finer = 0;
  for (std::uint64_t index = 1; index < 60; ++index) {
    const Case one = vary(1, index, seeds);
    EXPECT_EQ(to_json(one), to_json(vary(1, index, seeds)));
    EXPECT_EQ(to_json(case_from_json(to_json(one))), to_json(one));
    if (one.case_file.empty()) {
      ++changed;
    } else {
      ++finer;
      EXPECT_EQ(one.scene, seeds.front().scene);
      EXPECT_LE(one.dt, 1.0 / 60);
    }
  }
  EXPECT_GT(changed, 20);
  EXPECT_GT(finer, 5);
}

TEST(CaseSeeds, EnginesAreJudgedByWhatTheFileExpects) {
  const CaseFile right(kRight), wrong(kWrong);
  for (const char* name : {"plumb-float", "plumb", "plumb-precise"}) {
    const Engine engine(reference::find_backend(name));
    EXPECT_FALSE(case_file_verdict(vary(1, 0, {read_seed(right.path)}), engine)) << name;
    const Verdict verdict = case_file_verdict(vary(1, 0, {read_seed(wrong.path)}), engine);
    ASSERT_TRUE(verdict) << name;
    EXPECT_EQ(verdict->judge, "case_file: far away");
    EXPECT_FALSE(examine(engine, vary(1, 0, {read_seed(wrong.path)})).objections.empty());
  }
}

TEST(CaseSeeds, AFileIsNotAskedAboutAnotherScene) {
  const CaseFile wrong(kWrong);
  Case one = vary(1, 0, {read_seed(wrong.path)});
  one.scene.bodies.front().mass = 3;
  EXPECT_FALSE(case_file_verdict(one, Engine(reference::find_backend("plumb"))));
}

}  // namespace
}  // namespace plumb::harness::hunt
