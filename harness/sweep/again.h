#pragma once

#include <functional>
#include <span>
#include <vector>

#include "harness/compare.h"
#include "harness/result.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness::sweep {

struct AgainOptions {
  std::vector<scenarios::Instance> instances{};      ///< the scenes of the rows, known by their labels
  std::vector<const reference::Backend*> engines{};  ///< the engines of the rows, known by their names
  int jobs = 1;                                      ///< runs at a time
  double seconds_a_run = 300;                        ///< wall time after which a run is stopped
};

/// Repeats the runs of `rows`, each with the settings that were requested for it and measured at the same
/// instants. Costs are not measured. Rows of other scenes and engines are left out. Calls `finished` with the
/// runs of each scene. Returns false after an interrupt, which loses the runs of the current scene.
bool run_again(std::span<const Result> rows, const AgainOptions& options, const CompareEvents& events);

}  // namespace plumb::harness::sweep
