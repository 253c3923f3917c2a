#pragma once

#include <string>
#include <vector>

#include "harness/cluster/work_folder.h"

namespace plumb::app {

/// How a command is split into units.
struct PlanOptions {
  std::string folder, unit_seconds;
  std::vector<std::string> earlier;  ///< folders whose times the estimates are from
  int seeds = 8;                     ///< of a hunt
  int at_once = 1;                   ///< units at a time, which the time of a sweep's search counts on
  bool by_engine = false;
};

/// Splits a command, as it would be given to plumb, into units of `options.folder`, which gets copies of
/// scene files. Throws `UsageError` or `Error` for what the command would refuse.
harness::cluster::Plan plan_of(const PlanOptions& options, const std::vector<std::string>& words);

}  // namespace plumb::app
