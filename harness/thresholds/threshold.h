#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/thresholds/bisection.h"
#include "reference/backend.h"

/// Critical values: where a scene, turned by one number, changes from standing to falling.
namespace plumb::harness::thresholds {

/// The step of all runs, s: a game's.
inline constexpr double kStep = 1.0 / 60;

/// One run: a scene at one value of the number, and what says that it broke.
struct Trial {
  Scene scene;
  double duration = 0;  ///< s

  /// Asked after each step: empty as long as it holds, else what broke, as a short sentence. May keep what it
  /// needs from one step to the next.
  std::function<std::string(double time, std::span<const BodyState> states)> broke{};
};

struct Threshold {
  std::string name;   ///< "ramp_friction"
  std::string title;  ///< "the friction that holds a box on a slope"
  std::string
      quantity;  ///< what the number is: "friction coefficient at which a box stays on a slope of 20 degrees"
  std::string unit{};   ///< empty where it has none
  std::string source;   ///< where the exact value comes from, or why there is none
  std::string judged;   ///< what counts as broken, and why the run is long enough to tell
  SearchRange range{};  ///< without the resolution

  /// The exact value for an engine that steps so; nothing where there is none, as where any value holds.
  std::function<std::optional<double>(const reference::Method& method)> exact{};

  /// The run at `value`, long enough to tell apart what lies half of `resolution` off the exact value.
  std::function<Trial(double value, double resolution)> build{};
};

/// `exact` that is the same for all engines.
inline std::function<std::optional<double>(const reference::Method&)> exactly(double value) {
  return [value](const reference::Method&) { return value; };
}
inline std::optional<double> no_exact_value(const reference::Method&) { return std::nullopt; }

/// All of them, in the order in which they are told.
const std::vector<Threshold>& all();

/// The one called `name`. Throws `Error` (Name) that suggests the nearest.
const Threshold& find(std::string_view name);

}  // namespace plumb::harness::thresholds
