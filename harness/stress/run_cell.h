#pragma once

#include <functional>
#include <string>

#include "harness/isolate.h"
#include "harness/stress/cell.h"
#include "harness/stress/family.h"
#include "harness/stress/settings.h"
#include "reference/backend.h"

namespace plumb::harness::stress {

/// A cell that is to be run.
struct Task {
  const Family* family = nullptr;
  double value = 0;
  const reference::Backend* backend = nullptr;
  Setting setting{};
};

/// The cell of `task` before anything has run.
Cell blank(const Task& task);

/// Called once the settings are known, then with every sample: what is known of a run that may die.
using Witness = std::function<void(const Cell& so_far)>;

/// Runs a cell in this process: whatever the engine throws becomes an outcome, but a crash, a hang and a
/// flood of memory are the caller's.
Cell run_cell(const Task& task, const Witness& witness);

/// The same for all `tasks`, each in a process of its own and at most `jobs` at a time. `limits` of a cell
/// are multiplied by its family's patience. `done` is called as they end, in any order; after an interrupt
/// not for those that have not ended.
void run_cells(const std::vector<Task>& tasks, int jobs, const ChildLimits& limits,
               const std::function<void(std::size_t, const Cell&)>& done);

}  // namespace plumb::harness::stress
