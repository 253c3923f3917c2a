#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/stress/cell.h"

/// Results of `plumb stress` and `plumb thresholds`, for the report.
namespace plumb::harness::report {

struct Count {
  int survived = 0, total = 0;
};

/// Counts of the cells that an engine survives with one setting.
struct Endurance {
  std::string engine, setting;
  Count all{};
  std::map<std::string, Count> families{};  ///< by name
  std::map<std::string, int> outcomes{};    ///< cells by outcome, "skipped" included
};

struct Extremes {
  std::vector<stress::Cell> cells;      ///< the last of each engine, setting, family and value
  std::vector<std::string> thresholds;  ///< last line in thresholds.jsonl for each engine, setting and name
  bool empty() const { return cells.empty() && thresholds.empty(); }
};

/// Reads the folder's stress.jsonl and thresholds.jsonl, if they exist. Ignores a truncated last line. Throws
/// `Error` (Io, Syntax) that names file and line.
Extremes read_extremes(const std::string& folder);

/// Returns one row per engine and setting. plumb's engines come first; within each group engines are sorted
/// by their worst setting, ascending. Engines with several settings have one more row, for cells that survive
/// with any of them. The first row is that of any of plumb's engines with any setting.
std::vector<Endurance> endurances(const std::vector<stress::Cell>& cells);

/// Returns the families' names in the order of their first appearance.
std::vector<std::string> families_of(const std::vector<stress::Cell>& cells);

/// Returns the page's part of the data, as JSON.
std::string extremes_data(const Extremes& extremes);

/// Draws all families, one row per engine and setting: SVG, readable without colour, in light and dark.
std::string extremes_picture(const std::vector<stress::Cell>& cells);

}  // namespace plumb::harness::report
