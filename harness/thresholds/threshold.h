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

/// Critical values of one parameter at which a scene changes from standing to failing.
namespace plumb::harness::thresholds {

/// Step of all runs, s; that of a game.
inline constexpr double kStep = 1.0 / 60;

/// One run: a scene at one value of the parameter, and its failure criterion.
struct Trial {
  Scene scene;
  double duration = 0;  ///< s

  /// Called after each step: returns an empty string while the scene holds, else the failure as a short
  /// sentence. May keep state from step to step.
  std::function<std::string(double time, std::span<const BodyState> states)> broke{};
};

struct Threshold {
  std::string name;      ///< "ramp_friction"
  std::string title;     ///< "the friction that holds a box on a slope"
  std::string quantity;  ///< meaning of the parameter: "friction coefficient at which a box stays on a slope
                         ///< of 20 degrees"
  std::string unit{};    ///< empty for a number without a unit
  std::string source;    ///< source of the exact value, or the reason why there is none
  std::string judged;    ///< criterion of failure, and why the run is long enough to detect it
  SearchRange range{};   ///< without the resolution

  /// Returns the exact value for an engine with this method; nullopt if there is none, for example because
  /// any value holds.
  std::function<std::optional<double>(const reference::Method& method)> exact{};

  /// Builds the run at `value`, long enough to detect a deviation of half a `resolution` from the exact
  /// value.
  std::function<Trial(double value, double resolution)> build{};
};

/// Returns an `exact` that is the same for all engines.
inline std::function<std::optional<double>(const reference::Method&)> exactly(double value) {
  return [value](const reference::Method&) { return value; };
}
inline std::optional<double> no_exact_value(const reference::Method&) { return std::nullopt; }

/// Returns all thresholds, in the order of lists and reports.
const std::vector<Threshold>& all();

/// Returns the threshold called `name`. Throws `Error` (Name) that suggests the nearest name.
const Threshold& find(std::string_view name);

}  // namespace plumb::harness::thresholds
