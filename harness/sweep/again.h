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

/// Makes the runs of `rows` again, each with the settings that it was asked for and measured at the same
/// instants. Costs are not measured. Rows of other scenes and engines are left out. `finished` is called with
/// the runs of a scene; returns false after an interrupt, which loses those of the scene under way.
bool run_again(std::span<const Result> rows, const AgainOptions& options, const CompareEvents& events);

}  // namespace plumb::harness::sweep
