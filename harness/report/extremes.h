#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/stress/cell.h"

/// What `plumb stress` and `plumb thresholds` found, for the report.
namespace plumb::harness::report {

struct Count {
  int survived = 0, total = 0;
};

/// How an engine with one setting fares.
struct Endurance {
  std::string engine, setting;
  Count all{};
  std::map<std::string, Count> families{};  ///< by name
  std::map<std::string, int> outcomes{};    ///< cells by outcome, "skipped" included
};

struct Extremes {
  std::vector<stress::Cell> cells;      ///< by engine, setting, family and value the last
  std::vector<std::string> thresholds;  ///< lines of thresholds.jsonl, by engine, setting and name the last
  bool empty() const { return cells.empty() && thresholds.empty(); }
};

/// The folder's stress.jsonl and thresholds.jsonl where they are; a last line that was cut short is passed
/// over. Throws `Error` (Io, Syntax) that names file and line.
Extremes read_extremes(const std::string& folder);

/// A row an engine and setting: plumb's engines first, of these the one first that survives least with one of
/// its settings; then the others, likewise. Before them all what any of plumb's engines survives with any
/// setting; engines with several settings have a row of what any of these survives.
std::vector<Endurance> endurances(const std::vector<stress::Cell>& cells);

/// The families' names in the order in which they first appear.
std::vector<std::string> families_of(const std::vector<stress::Cell>& cells);

/// The page's part of the data, as JSON.
std::string extremes_data(const Extremes& extremes);

/// A picture of all families, a row an engine and setting: SVG, readable without colour, in light and dark.
std::string extremes_picture(const std::vector<stress::Cell>& cells);

}  // namespace plumb::harness::report
