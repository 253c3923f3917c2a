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
  reference::Settings settings{};  ///< effective; the requested ones if the engine did not start
  Finding finding{};
  long steps = 0;             ///< steps that were made
  double seconds = 0;         ///< wall time of the cell
  double engine_seconds = 0;  ///< part of it that the engine spent on the steps
  std::size_t memory = 0;     ///< bytes, at the peak, of its process

  bool counted() const { return finding.verdict != Verdict::Skipped; }
  bool survived() const { return finding.verdict == Verdict::Ok; }
};

/// Returns the key of a cell in a folder.
std::string key_of(std::string_view family, double value, std::string_view engine, std::string_view setting);
std::string key_of(const Cell& cell);

/// Converts to one line of JSON. `cell_from_json` throws `Error` (Syntax).
std::string to_json(const Cell& cell);
Cell cell_from_json(std::string_view text);

/// Returns one line of CSV, after `csv_columns`.
std::string_view csv_columns();
std::string to_csv(const Cell& cell);

}  // namespace plumb::harness::stress
