#pragma once

#include <functional>
#include <string>

#include "harness/isolate.h"
#include "harness/stress/cell.h"
#include "harness/stress/family.h"
#include "harness/stress/settings.h"
#include "reference/backend.h"

namespace plumb::harness::stress {

/// A cell to be run.
struct Task {
  const Family* family = nullptr;
  double value = 0;
  const reference::Backend* backend = nullptr;
  Setting setting{};
};

/// Returns the cell of `task` before anything has run.
Cell blank(const Task& task);

/// Called once when the settings are known and after every sample, so that the facts survive if the run's
/// process dies.
using Witness = std::function<void(const Cell& so_far)>;

/// Runs a cell in this process. Exceptions of the engine become an outcome; crashes, hangs and memory
/// exhaustion are left to the caller.
Cell run_cell(const Task& task, const Witness& witness);

/// Runs all `tasks`, each in a process of its own and at most `jobs` at a time. The time limit of a cell is
/// `limits.seconds` times its family's patience. Calls `done` as cells end, in any order; after an interrupt,
/// unfinished cells are left out.
void run_cells(const std::vector<Task>& tasks, int jobs, const ChildLimits& limits,
               const std::function<void(std::size_t, const Cell&)>& done);

}  // namespace plumb::harness::stress
