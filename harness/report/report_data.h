#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "harness/report/environments.h"
#include "harness/report/extremes.h"
#include "harness/result.h"

namespace plumb::harness::report {

/// Returns the page's data as one JSON object without any "<", so that it can stand in HTML. `replays`: JSON
/// by `sweep::key_of`.
std::string report_data(const std::string& title, std::span<const Result> rows,
                        const std::vector<EnvironmentUse>& environments,
                        const std::map<std::string, std::string>& replays, const Extremes& extremes = {});

/// Returns the page around it: one HTML file that loads nothing else.
std::string report_page(const std::string& title, const std::string& data);

}  // namespace plumb::harness::report
