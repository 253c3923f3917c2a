#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "harness/stress/family.h"
#include "reference/backend.h"

namespace plumb::harness::stress {

/// One engine with one setting on one scene of a family: a line of stress.jsonl.
struct Cell {
  std::string family{}, title{}, axis{}, unit{};
  double value = 0;  ///< on the axis
  std::string engine{}, setting{};
  double dt = 0;                   ///< s
  reference::Settings settings{};  ///< effective; what was asked for where the engine did not get to say
  Finding finding{};
  long steps = 0;             ///< that were made
  double seconds = 0;         ///< wall time of the cell
  double engine_seconds = 0;  ///< of these the engine's own, for the steps
  std::size_t memory = 0;     ///< bytes, at the peak, of its process

  bool counted() const { return finding.verdict != Verdict::Skipped; }
  bool survived() const { return finding.verdict == Verdict::Ok; }
};

/// What a cell is known by, in a folder.
std::string key_of(std::string_view family, double value, std::string_view engine, std::string_view setting);
std::string key_of(const Cell& cell);

/// As one line of JSON. `cell_from_json` throws `Error` (Syntax).
std::string to_json(const Cell& cell);
Cell cell_from_json(std::string_view text);

/// As one line of CSV, after `csv_columns`.
std::string_view csv_columns();
std::string to_csv(const Cell& cell);

}  // namespace plumb::harness::stress
