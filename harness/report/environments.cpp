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

void add(std::vector<EnvironmentUse>& uses, const Environment& where) {
  const auto known = std::find_if(uses.begin(), uses.end(),
                                  [&](const EnvironmentUse& use) { return same_place(use.where, where); });
  if (known == uses.end()) {
    uses.push_back({where, where.date, 1});
  } else {
    ++known->runs;
    // ISO 8601 in UTC sorts as text.
    known->last = std::max(known->last, where.date);
    known->where.date = std::min(known->where.date, where.date);
  }
}

}  // namespace

std::vector<EnvironmentUse> read_environments(const std::string& folder_or_file) {
  std::error_code code;
  const std::filesystem::path path(folder_or_file);
  std::ifstream file(std::filesystem::is_directory(path, code) ? path / "results.jsonl" : path,
                     std::ios::binary);
  std::vector<EnvironmentUse> out;
  for (std::string line; std::getline(file, line);) {
    const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("environment") || !json["environment"].is_object()) continue;
    const auto text = [&](const char* name) {
      const nlohmann::json& environment = json["environment"];
      return environment.contains(name) && environment[name].is_string()
                 ? environment[name].get<std::string>()
                 : std::string();
    };
    add(out, {.plumb_version = text("plumb_version"),
              .commit = text("commit"),
              .compiler = text("compiler"),
              .flags = text("flags"),
              .build_type = text("build_type"),
              .cpu = text("cpu"),
              .os = text("os"),
              .date = text("date")});
  }
  return out;
}

}  // namespace plumb::harness::report
