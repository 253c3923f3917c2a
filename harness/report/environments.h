#pragma once

#include <string>
#include <vector>

#include "harness/environment.h"

namespace plumb::harness::report {

/// Environment of some of a folder's results.
struct EnvironmentUse {
  Environment where;  ///< `date`: of the first
  std::string last;   ///< date of the last
  int runs = 0;
};

/// Reads the different environments of a folder's results.jsonl, stress.jsonl and thresholds.jsonl, or of one
/// file, in the order in which they first appear. Those that differ only in the date count as one. Unreadable
/// lines are skipped, because reading the results themselves reports them.
std::vector<EnvironmentUse> read_environments(const std::string& folder_or_file);

}  // namespace plumb::harness::report
