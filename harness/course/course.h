#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// The course's five chapters as checks that any engine can be put through.
namespace plumb::course {

/// One thing that an engine must get right.
struct Check {
  std::string name;   ///< unique: "heavy_hits_light"
  std::string title;  ///< what holds, in a line
  std::string wants;  ///< what the engine declares in answer to "hello" (docs/protocol.md)
  Finding (*run)(const Lab& lab) = nullptr;
};

struct Chapter {
  int number = 0;
  std::string title;
  std::string page;  ///< under docs/course
  std::vector<Check> checks;
};

Chapter bouncing_ball();
Chapter cannonballs();
Chapter circle_collisions();
Chapter rotation_and_boxes();
Chapter constraints_and_ragdoll();

/// All five, in order.
std::vector<Chapter> chapters();

struct Outcome {
  const Chapter* chapter = nullptr;
  const Check* check = nullptr;
  Finding finding;
};

/// Puts `engine` through `chapters`, one check after another; `done` hears of each. An engine that hangs,
/// crashes or loses a number has a broken check; after `kPatience` that hang the rest is not tried.
std::vector<Outcome> examine(const reference::Backend& engine, const reference::StepSettings& settings,
                             std::span<const Chapter> chapters,
                             const std::function<void(const Outcome&)>& done);

inline constexpr int kPatience = 3;

}  // namespace plumb::course
