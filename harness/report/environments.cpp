#include "harness/report/environments.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

namespace plumb::harness::report {
namespace {

bool same_place(const Environment& a, const Environment& b) {
  return a.plumb_version == b.plumb_version && a.commit == b.commit && a.compiler == b.compiler &&
         a.flags == b.flags && a.build_type == b.build_type && a.cpu == b.cpu && a.os == b.os;
}

void add(std::vector<EnvironmentUse>& uses, const Environment& where, int runs) {
  const auto known = std::find_if(uses.begin(), uses.end(),
                                  [&](const EnvironmentUse& use) { return same_place(use.where, where); });
  if (known == uses.end()) {
    uses.push_back({where, where.date, runs});
  } else {
    known->runs += runs;
    // ISO 8601 in UTC sorts as text.
    known->last = std::max(known->last, where.date);
    known->where.date = std::min(known->where.date, where.date);
  }
}

Environment environment_from(const nlohmann::json& json) {
  const auto text = [&](const char* name) {
    return json.contains(name) && json[name].is_string() ? json[name].get<std::string>() : std::string();
  };
  return {.plumb_version = text("plumb_version"),
          .commit = text("commit"),
          .compiler = text("compiler"),
          .flags = text("flags"),
          .build_type = text("build_type"),
          .cpu = text("cpu"),
          .os = text("os"),
          .date = text("date")};
}

/// A line of results contains its environment; other logs have it on a line of its own, before the runs.
void read_log(const std::filesystem::path& path, std::vector<EnvironmentUse>& out) {
  std::ifstream file(path, std::ios::binary);
  Environment before;
  bool known = false;
  for (std::string line; std::getline(file, line);) {
    const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object()) continue;
    if (json.value("kind", nlohmann::json()) == "environment") {
      before = environment_from(json.contains("environment") ? json["environment"] : json);
      known = true;
    } else if (json.contains("environment") && json["environment"].is_object()) {
      add(out, environment_from(json["environment"]), 1);
    } else if (known) {
      add(out, before, 1);
    }
  }
}

}  // namespace

std::vector<EnvironmentUse> read_environments(const std::string& folder_or_file) {
  std::error_code code;
  const std::filesystem::path path(folder_or_file);
  std::vector<EnvironmentUse> out;
  if (std::filesystem::is_directory(path, code)) {
    for (const char* name : {"results.jsonl", "stress.jsonl", "thresholds.jsonl"}) read_log(path / name, out);
  } else {
    read_log(path, out);
  }
  return out;
}

}  // namespace plumb::harness::report
