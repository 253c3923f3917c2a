#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace plumb::harness::report {

/// The pose of a body at a moment: x, y in m, angle in rad.
struct Pose {
  double x = 0, y = 0, angle = 0;
};

/// What a scene looks like and how it truly moves.
struct Stage {
  std::string summary;  ///< of the scenario
  scenarios::Problem problem;
  std::vector<double> times;  ///< s, evenly apart, from 0 to the duration
  std::vector<std::vector<Pose>>
      truth;  ///< a row a time, a pose a body; empty where there is no known answer
};

/// The stage of the scene that the command line calls `label`; nothing where no scenario has this name.
std::optional<Stage> stage_of(const std::string& label, int frames);

}  // namespace plumb::harness::report
