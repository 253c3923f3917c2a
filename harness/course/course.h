#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// The course's five chapters, as checks that run on any engine.
namespace plumb::course {

/// One requirement on an engine.
struct Check {
  std::string name;   ///< unique: "heavy_hits_light"
  std::string title;  ///< the expected behaviour, in a line
  std::string wants;  ///< capability that the engine must declare in answer to "hello" (docs/protocol.md)
  Finding (*run)(const Lab& lab) = nullptr;
  /// False if the motion depends on details in which correct engines differ, as with many bodies that
  /// collide.
  bool repeatable = true;
};

struct Chapter {
  int number = 0;
  std::string title;
  std::string page;  ///< file below docs/course
  std::vector<Check> checks;
};

Chapter bouncing_ball();
Chapter cannonballs();
Chapter circle_collisions();
Chapter rotation_and_boxes();
Chapter constraints_and_ragdoll();

/// Returns all five, in order.
std::vector<Chapter> chapters();

struct Outcome {
  const Chapter* chapter = nullptr;
  const Check* check = nullptr;
  Finding finding;
  std::vector<Recorded> runs{};  ///< runs of the check, in order; those of a second attempt last
};

/// Name of the mistake of an engine whose repeated runs of one scene differ: none of its figures can then be
/// explained.
inline constexpr const char* kRunsDiffer = "runs_differ";

/// Runs `chapters` on `engine`, one check after another. Calls `done` for each check at the end of its
/// chapter, because a mistake is identified by its effect on all checks of the chapter. After a failure
/// without a name, `done` waits for the chapter that names a mistake: it may be the cause of that failure. If
/// the engine fails, hangs or returns a non-finite figure, the check is broken. After `kPatience` hangs the
/// rest is skipped.
std::vector<Outcome> examine(const reference::Backend& engine, const reference::StepSettings& settings,
                             std::span<const Chapter> chapters,
                             const std::function<void(const Outcome&)>& done);

inline constexpr int kPatience = 3;

}  // namespace plumb::course
