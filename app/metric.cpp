#include "app/metric.h"

#include <algorithm>
#include <vector>

#include <CLI/CLI.hpp>

namespace plumb::app {

void add_metric(CLI::App& command, std::string& metric, const std::string& help) {
  std::vector<std::string> names;
  for (const harness::MetricField& field : harness::kMetricFields) names.emplace_back(field.name);
  command.add_option("--metric", metric, help)->type_name("M")->check(CLI::IsMember(names));
}

const harness::MetricField& metric_by_name(const std::string& name) {
  return *std::find_if(harness::kMetricFields.begin(), harness::kMetricFields.end(),
                       [&](const harness::MetricField& field) { return field.name == name; });
}

}  // namespace plumb::app
