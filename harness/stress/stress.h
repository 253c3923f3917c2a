#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/compare.h"
#include "harness/stress/cell.h"
#include "harness/stress/family.h"
#include "reference/backend.h"

namespace plumb::harness::stress {

struct StressOptions {
  std::vector<const Family*> families;
  std::vector<const reference::Backend*> engines;
  std::string folder;                   ///< folder of stress.jsonl
  int jobs = 1;                         ///< cells run at a time
  bool quick = false;                   ///< every third value of each axis
  double cell_seconds = 10;             ///< time limit of a cell; a family may have a multiple of it
  std::size_t cell_memory = 2ul << 30;  ///< bytes of address space of a cell's process and its children
};

struct StressEvents {
  std::function<void(const Progress&)> progress{};
  /// Receives a family's cells when all are complete, including those that were complete before.
  std::function<void(const Family&, const std::vector<Cell>&)> finished{};
};

struct Stressed {
  std::vector<Cell> cells;  ///< by family, engine, setting and value, in the requested order
  bool interrupted = false;
};

/// Returns the values of `family` that a run uses.
std::vector<double> values_of(const Family& family, bool quick);

/// Runs every engine in all its settings through every value of the families, each cell in a process of its
/// own. Appends each to `stress.jsonl` as it ends; cells already there are not run again. Throws `Error` (Io;
/// Value if the folder's cells are of another build, machine or limit).
Stressed stress(const StressOptions& options, const StressEvents& events = {});

}  // namespace plumb::harness::stress
