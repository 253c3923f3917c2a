#pragma once

#include <string>
#include <vector>

namespace plumb {

/// One stage of a step, with the reason why the scene needs it.
struct Stage {
  std::string name;        ///< "broad_phase", "joint_solve", ...
  std::string why;         ///< "2 of 4 bodies have shapes that may touch"
  bool active = true;      ///< inactive stages are listed with the reason, but neither allocate nor run
  double nanoseconds = 0;  ///< time spent since profiling was switched on
};

/// The stages that `compile` derived from the scene, in the order of execution.
struct Plan {
  std::string driver;  ///< "world<double>", "world<float>", "precise"
  std::vector<Stage> stages;
  int substeps = 1;            ///< Realtime: substeps per step
  std::string substeps_why{};  ///< "as asked for", or the reason for a larger number
};

}  // namespace plumb
