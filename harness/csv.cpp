#include <string>
#include <string_view>

#include <fmt/format.h>

#include "harness/table.h"

namespace plumb::harness {
namespace {

// RFC 4180: quoted where it has to be, quotes doubled.
std::string field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string csv_header() {
  std::string line = "scenario,variant,size,engine,engine_version,precision,dt,status,reason";
  for (const MetricField& metric : kMetricFields) line += fmt::format(",{}", metric.name);
  return line + ",ns_per_step,ns_per_simulated_second,setup_ns,checks,checks_missed,as_expected";
}

std::string csv_row(const Result& result) {
  std::string line =
      fmt::format("{},{},{},{},{},{},{},{},{}", field(result.scenario), field(result.variant), result.size,
                  field(result.engine), field(result.engine_version), field(result.precision), result.dt,
                  name_of(result.status), field(result.reason));
  for (const MetricField& metric : kMetricFields) {
    const auto& value = result.metrics.*metric.value;
    line += value ? fmt::format(",{}", *value) : ",";
  }
  line += result.cost ? fmt::format(",{},{},{}", result.cost->ns_per_step,
                                    result.cost->ns_per_simulated_second, result.cost->setup_ns)
                      : ",,,";
  int missed = 0;
  for (const Check& check : result.checks) missed += check.pass ? 0 : 1;
  return line +
         fmt::format(",{},{},{}", result.checks.size(), missed, result.unexpected.empty() ? "yes" : "no");
}

}  // namespace plumb::harness
