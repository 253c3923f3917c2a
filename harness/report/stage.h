#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace plumb::harness::report {

/// Pose of a body at a moment: x, y in m, angle in rad.
struct Pose {
  double x = 0, y = 0, angle = 0;
};

/// Appearance of a scene and its true motion.
struct Stage {
  std::string summary;  ///< of the scenario
  scenarios::Problem problem;
  std::vector<double> times;  ///< s, evenly apart, from 0 to the duration
  std::vector<std::vector<Pose>>
      truth;  ///< one row per time, one pose per body; empty if there is no known answer
};

/// Returns the stage of the scene that the command line calls `label`; nullopt if no scenario has this name.
std::optional<Stage> stage_of(const std::string& label, int frames);

}  // namespace plumb::harness::report
