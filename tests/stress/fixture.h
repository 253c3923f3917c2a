#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <stdlib.h>

#include "harness/stress/rules.h"
#include "harness/stress/run_cell.h"
#include "tests/harness/fakes.h"

/// Families and engines with known mistakes, to test the maps by.
namespace plumb::harness::stress {

/// A folder of its own that is gone with it.
class Folder {
 public:
  Folder() {
    std::string name = std::filesystem::temp_directory_path() / "plumb_stress_XXXXXX";
    path_ = mkdtemp(name.data());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }
  const std::string& path() const { return path_; }
  std::vector<std::string> lines() const {
    std::ifstream file(path_ + "/stress.jsonl");
    std::vector<std::string> out;
    for (std::string line; std::getline(file, line);) out.push_back(line);
    return out;
  }

 private:
  std::string path_;
};

/// A box rests on a floor beside a wall; two rods hang from each other. The axis is a number that scenes know
/// nothing of.
inline Trial mixed(double) {
  Trial trial{.scene = {.name = "mixed"}, .stretches = {{10, 6}}};
  trial.scene.bodies = {
      {.name = "box", .position = {0, 0.5}, .shapes = {{.geometry = Box{1, 1}}}},
      {.name = "floor",
       .type = BodyType::Static,
       .position = {0, -0.5},
       .shapes = {{.geometry = Box{10, 1}}}},
      {.name = "rod", .position = {3, 4.5}, .shapes = {{.geometry = Box{0.1, 1}, .filter = {.mask = 0}}}}};
  trial.scene.joints = {RevoluteJoint{
      .name = "hinge", .body_a = "world", .body_b = "rod", .anchor_a = {3, 5}, .anchor_b = {0, 0.5}}};
  trial.judge = [](const Scene& scene) {
    Rule wall{
        .measure = "distance past the wall", .unit = "m", .bound = 0, .beyond = Verdict::Tunnels, .sane = 0};
    wall.figure = [](double, std::span<const BodyState> states) {
      return std::max(0.0, states[0].position.x - 2);
    };
    Rule speed{.measure = "speed lost", .bound = 0.5, .beyond = Verdict::Freezes, .sane = 0.5};
    speed.figure = [](double, std::span<const BodyState> states) {
      return std::max(0.0, -states[0].angular_velocity);
    };
    return judge_by({deepest_overlap(scene, 0.01), farthest_from_start(scene, 3, 100),
                     sum_of_gaps(scene, 0.01, 10), wall, speed});
  };
  return trial;
}

inline Family family(std::string name, std::vector<double> values = {1, 2, 3, 4, 5}) {
  Family out{.name = std::move(name),
             .title = "a box and a rod",
             .axis = "number",
             .rule = "it stays",
             .build = mixed};
  out.values = std::move(values);
  return out;
}

/// A fake that does something to the box (0) and the rod (2) from its fifth step on.
inline fakes::FakeBackend engine(
    std::string name, fakes::Motion motion = [](long, double, std::span<BodyState>) {}) {
  return {std::move(name), std::move(motion)};
}

}  // namespace plumb::harness::stress
