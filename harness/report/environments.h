#pragma once

#include <string>
#include <vector>

#include "harness/environment.h"

namespace plumb::harness::report {

/// Where some of a folder's results were measured.
struct EnvironmentUse {
  Environment where;  ///< `date`: of the first
  std::string last;   ///< date of the last
  int runs = 0;
};

/// The different environments of a folder's results.jsonl, stress.jsonl and thresholds.jsonl, or of one file,
/// in the order in which they first appear; dates apart. Lines that cannot be read are passed over: reading
/// the results themselves says what is wrong with them.
std::vector<EnvironmentUse> read_environments(const std::string& folder_or_file);

}  // namespace plumb::harness::report
