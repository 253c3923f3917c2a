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
  std::string folder;                   ///< stress.jsonl is kept there
  int jobs = 1;                         ///< cells at a time
  bool quick = false;                   ///< every third value of each axis
  double cell_seconds = 10;             ///< wall time of a cell; a family may take a multiple
  std::size_t cell_memory = 2ul << 30;  ///< bytes of address space of a cell's process, and of what it starts
};

struct StressEvents {
  std::function<void(const Progress&)> progress{};
  /// A family's cells, once all are there; also where they were there before.
  std::function<void(const Family&, const std::vector<Cell>&)> finished{};
};

struct Stressed {
  std::vector<Cell> cells;  ///< by family, engine, setting and value, as asked for
  bool interrupted = false;
};

/// The values of `family` that a run takes.
std::vector<double> values_of(const Family& family, bool quick);

/// Runs every engine in all its settings through every value of the families, each cell in a process of its
/// own, and appends each to `stress.jsonl` as it ends. Cells that are there are not run again. Throws `Error`
/// (Io; Value where the folder's cells are of another build, machine or limit).
Stressed stress(const StressOptions& options, const StressEvents& events = {});

}  // namespace plumb::harness::stress
