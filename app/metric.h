#pragma once

#include <string>

#include "harness/metrics.h"

namespace CLI {
class App;
}

namespace plumb::app {

/// Adds --metric, which takes the names of `harness::kMetricFields`.
void add_metric(CLI::App& command, std::string& metric, const std::string& help);

/// Returns the metric called `name`.
const harness::MetricField& metric_by_name(const std::string& name);

}  // namespace plumb::app
