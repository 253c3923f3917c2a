#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "harness/table.h"

namespace plumb::harness {

namespace {

std::string spaced(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : " ") + part;
  return out;
}

}  // namespace

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string csv_header() {
  std::string line = "scenario,variant,size,engine,engine_version,precision,dt,status,reason";
  for (const MetricField& metric : kMetricFields) line += fmt::format(",{}", metric.name);
  return line +
         ",ns_per_step,ns_per_simulated_second,setup_ns,checks,checks_missed,as_expected,"
         "agrees_with_truth,agrees_with,disagrees_with,missed,reasons";
}

std::string csv_row(const Result& result) {
  std::string line =
      fmt::format("{},{},{},{},{},{},{},{},{}", csv_field(result.scenario), csv_field(result.variant),
                  result.size, csv_field(result.engine), csv_field(result.engine_version),
                  csv_field(result.precision), result.dt, name_of(result.status), csv_field(result.reason));
  for (const MetricField& metric : kMetricFields) {
    const auto& value = result.metrics.*metric.value;
    line += value ? fmt::format(",{}", *value) : ",";
  }
  line += result.cost ? fmt::format(",{},{},{}", result.cost->ns_per_step,
                                    result.cost->ns_per_simulated_second, result.cost->setup_ns)
                      : ",,,";
  std::vector<std::string> misses, reasons;
  for (const Check& check : result.checks) {
    if (check.pass) continue;
    misses.push_back(fmt::format("{}={}/{}", check.name, check.value, check.tolerance));
    if (!check.known_limit.empty() && std::ranges::find(reasons, check.known_limit) == reasons.end())
      reasons.push_back(check.known_limit);
  }
  const std::optional<bool> agrees = result.agrees_with_truth();
  return line + fmt::format(",{},{},{},{},{},{},{},{}", result.checks.size(), misses.size(),
                            result.unexpected.empty() ? "yes" : "no",
                            !agrees   ? ""
                            : *agrees ? "yes"
                                      : "no",
                            csv_field(spaced(result.agrees_with)), csv_field(spaced(result.disagrees_with)),
                            csv_field(spaced(misses)), csv_field(spaced(reasons)));
}

}  // namespace plumb::harness
