#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/cluster/gather.h"
#include "harness/cluster/work_folder.h"

namespace plumb::harness::cluster {

/// Units that the results so far call for, not numbered yet.
struct NextRound {
  std::vector<Unit> units;
  int further = 0;  ///< of these: those that go on from units that are done
  int again = 0;    ///< of these: measured again, because others disturbed the first time
};

/// Plans the next round. If all units with the same `then` are done or given up, adds the unit that `then`
/// describes, with "--from" and the folder of each. Adds repetitions of units that measure costs and were
/// disturbed, on hosts that did not disturb them, at most `kAttempts` times in all.
NextRound next_round(const std::string& folder, const Plan& plan, const Survey& survey);

/// Returns by number the attempt whose results count, of a unit and its repetitions: the first that was not
/// disturbed, or else the least disturbed. Those of which none is done are left out.
std::map<int, const Done*> least_disturbed(const Plan& plan, const Survey& survey);

}  // namespace plumb::harness::cluster
