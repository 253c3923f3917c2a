#pragma once

#include <string>
#include <vector>

namespace plumb {

/// One thing that a step does for a scene, and why that scene needs it.
struct Stage {
  std::string name;        ///< "broad_phase", "joint_solve", ...
  std::string why;         ///< "2 of 4 bodies have shapes that may touch"
  bool active = true;      ///< inactive stages are listed with the reason, and neither allocate nor run
  double nanoseconds = 0;  ///< time spent since profiling was switched on
};

/// What `compile` derived from the scene: the stages in the order in which a step runs them.
struct Plan {
  std::string driver;  ///< "realtime<double>", "realtime<float>", "precise"
  std::vector<Stage> stages;
  int substeps = 1;            ///< Realtime: of a step
  std::string substeps_why{};  ///< "as asked for", or what of the scene needs more
};

}  // namespace plumb
