#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/compare.h"
#include "harness/result.h"
#include "harness/sweep/space.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness::sweep {

/// Fraction of a sweep's time for finding the fronts; the rest is for measuring costs.
inline constexpr double kExploring = 0.55;

struct SweepOptions {
  std::vector<scenarios::Instance> instances;
  std::vector<const reference::Backend*> engines;
  std::string folder;   ///< folder of results.jsonl and sweep.jsonl
  double budget = 540;  ///< s of wall time for all instances
  /// s for finding the fronts of all instances. If set, no cost is measured and no result is written; a later
  /// sweep with this folder in `from` does that. 0: fronts and costs.
  double only_explore = 0;
  std::vector<std::string>
      from{};                    ///< folders of sweeps whose runs are taken over, by the same build of plumb
  int repetitions = 9;           ///< of every cost
  double seconds_a_run = 20;     ///< time limit of a run
  std::size_t most_points = 48;  ///< per engine and instance
  Ladder ladder{};
};

struct SweepEvents {
  /// Called once per instance with its rows when they are complete, including instances that were complete
  /// before.
  std::function<void(std::span<const Result>)> finished{};
  /// `done` and `total` are thousandths of the budget.
  std::function<void(const Progress&)> progress{};
};

struct Swept {
  std::vector<Result> rows;
  bool interrupted = false;
  int dropped = 0;  ///< settings whose cost was not measured, because the budget was too small
};

/// Runs every engine on every instance with the values of its knobs, and approaches its Pareto front of error
/// and cost. Then measures costs in repetitions in which all points of an instance take turns. Appends
/// everything to `sweep.jsonl` as it comes, and an instance's rows to `results.jsonl` when it is complete.
/// The same call resumes an interrupted sweep. Throws `Error` (Io; Value if the folder is another sweep's).
Swept sweep(const SweepOptions& options, const SweepEvents& events = {});

}  // namespace plumb::harness::sweep
