#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/cluster/gather.h"
#include "harness/cluster/work_folder.h"

namespace plumb::harness::cluster {

/// Units that follow from the results so far, not numbered yet.
struct NextRound {
  std::vector<Unit> units;
  int further = 0;  ///< number of these that continue units already done
  int again = 0;    ///< number of these that repeat measurements which other processes disturbed
};

/// Plans the next round. If all units with the same `then` are done or given up, adds the unit that `then`
/// describes, with "--from" and the folder of each. Adds repetitions of units that measure costs and were
/// disturbed, on hosts that did not disturb them, at most `kAttempts` times in all.
NextRound next_round(const std::string& folder, const Plan& plan, const Survey& survey);

/// Returns for each unit, by its number, the attempt whose results count (the unit itself or a repetition):
/// the first undisturbed one, otherwise the least disturbed. Leaves out units without a completed attempt.
std::map<int, const Done*> least_disturbed(const Plan& plan, const Survey& survey);

}  // namespace plumb::harness::cluster
