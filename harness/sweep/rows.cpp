#include "harness/sweep/rows.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/text_file.h"

namespace plumb::harness::sweep {
namespace {

std::string file_of(const std::string& folder_or_file) {
  std::error_code code;
  const std::filesystem::path path(folder_or_file);
  return std::filesystem::is_directory(path, code) ? (path / "results.jsonl").string() : folder_or_file;
}

using Kinds = std::vector<std::pair<std::string, int>>;  // kind of machine, costs; in order of appearance

void add(Kinds& kinds, const std::string& machine, int count) {
  const auto known =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) { return kind.first == machine; });
  if (known == kinds.end()) {
    kinds.emplace_back(machine, count);
  } else {
    known->second += count;
  }
}

std::map<std::string, Kinds> costs_by_machine(std::span<const Result> rows) {
  std::map<std::string, Kinds> out;  // by scene
  for (const Result& row : rows)
    if (row.cost && !row.machine.empty()) add(out[row.label], row.machine, 1);
  return out;
}

// Returns the kinds, those with the most costs first; kinds with equal numbers keep their order.
std::vector<std::string> most_first(Kinds kinds) {
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> out;
  for (auto& [kind, count] : kinds) out.push_back(std::move(kind));
  return out;
}

void require_machine(const std::vector<Result>& rows, const std::string& machine) {
  std::string others;
  for (const Result& row : rows) {
    if (!row.cost || row.machine.empty()) continue;
    if (row.machine == machine) return;
    if (others.find("'" + row.machine + "'") == std::string::npos)
      others += fmt::format("{}'{}'", others.empty() ? "" : ", ", row.machine);
  }
  throw Error(Error::Kind::Name, "a kind of machine", "", machine,
              others.empty() ? "has no costs here" : "has no costs here; there are costs of " + others);
}

}  // namespace

std::string key_of(const Result& row) {
  std::string key = fmt::format("{}|{}|dt={}", row.label, row.engine, row.asked.dt);
  if (row.asked.substeps) key += fmt::format("|substeps={}", *row.asked.substeps);
  if (row.asked.tolerance) key += fmt::format("|tolerance={}", *row.asked.tolerance);
  for (const auto& [name, value] : row.asked.options) key += fmt::format("|{}={}", name, value);
  return key;
}

std::vector<std::vector<Result>> by_label(std::span<const Result> rows) {
  std::vector<std::vector<Result>> out;
  std::map<std::string, std::size_t> places;
  for (const Result& row : rows) {
    const auto [place, fresh] = places.try_emplace(row.label, out.size());
    if (fresh) out.emplace_back();
    out[place->second].push_back(row);
  }
  return out;
}

std::vector<std::string> engines_of(std::span<const Result> rows) {
  std::vector<std::string> out;
  for (const Result& row : rows)
    if (std::find(out.begin(), out.end(), row.engine) == out.end()) out.push_back(row.engine);
  return out;
}

std::vector<Result> latest(std::vector<Result> rows) {
  std::map<std::string, std::size_t> places;
  std::vector<Result> out;
  for (Result& row : rows) {
    const auto [place, fresh] = places.try_emplace(key_of(row), out.size());
    if (fresh) {
      out.push_back(std::move(row));
    } else {
      out[place->second] = std::move(row);
    }
  }
  return out;
}

void keep_costs_of_one_machine(std::vector<Result>& rows, const std::string& machine) {
  std::map<std::string, std::string> most;  // by scene
  if (machine.empty())
    for (const auto& [label, kinds] : costs_by_machine(rows)) most[label] = most_first(kinds).front();
  if (!machine.empty()) require_machine(rows, machine);
  for (Result& row : rows) {
    if (!row.cost || row.machine.empty() || row.machine == machine) continue;
    if (machine.empty() && most[row.label] == row.machine) continue;
    row.cost.reset();
    row.cost_left_out = true;
  }
}

std::vector<std::string> machines_of(std::span<const Result> rows) {
  Kinds all;
  for (const auto& [label, kinds] : costs_by_machine(rows))
    for (const auto& [kind, count] : kinds) add(all, kind, count);
  return most_first(all);
}

void for_each_row(const std::string& folder_or_file, const std::function<void(Result)>& take) {
  const std::string path = file_of(folder_or_file);
  std::ifstream file = open_text(path, "`plumb compare` and `plumb sweep` write such files");
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty()) continue;
    Result row;
    try {
      row = result_from_json(line);
    } catch (const Error& error) {
      if (file.eof()) break;  // no line end: the writer was stopped within the line
      throw Error(Error::Kind::Syntax, fmt::format("file '{}', line {}", path, number), "", "", error.what());
    }
    take(std::move(row));
  }
}

std::vector<Result> read_all_costs(const std::string& folder_or_file) {
  std::vector<Result> rows;
  for_each_row(folder_or_file, [&](Result row) { rows.push_back(std::move(row)); });
  return latest(std::move(rows));
}

std::vector<Result> read_rows(const std::string& folder_or_file, const std::string& machine) {
  std::vector<Result> rows = read_all_costs(folder_or_file);
  keep_costs_of_one_machine(rows, machine);
  return rows;
}

void require_rows(const std::vector<Result>& rows, const std::string& folder_or_file) {
  if (!rows.empty()) return;
  throw Error(Error::Kind::Value, fmt::format("'{}'", folder_or_file), "", "",
              "has no results: `plumb compare --out DIR` or `plumb sweep --out DIR` writes some");
}

bool holds_rows(const std::string& folder_or_file) {
  std::error_code code;
  return std::filesystem::is_regular_file(file_of(folder_or_file), code);
}

}  // namespace plumb::harness::sweep
