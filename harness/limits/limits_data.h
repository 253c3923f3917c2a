#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/report/extremes.h"
#include "harness/thresholds/finding.h"

/// Data that docs/limits.md is generated from: the results of `plumb stress` and `plumb thresholds`, without
/// figures that differ from run to run.
namespace plumb::harness::limits {

/// One engine with one setting on one family.
struct FamilyRow {
  std::string family, title, axis, unit, engine, setting;
  std::vector<double> values{};         ///< of the axis, ascending
  std::vector<std::string> outcomes{};  ///< as many
  std::vector<std::string> reasons{};   ///< one for each value; empty except next to the surviving range

  /// Returns the longest range of values that survive, as the index of the first one and one past the last;
  /// equal if there is none.
  std::pair<std::size_t, std::size_t> survived_range() const;
  std::size_t survived() const;
  bool skipped() const;  ///< true if the engine lacks a feature that the family needs
};

struct LimitsData {
  std::string measured;  ///< "plumb 0.1.0, commit abc, on CPU"; empty if unknown
  std::vector<FamilyRow> rows;
  std::vector<thresholds::Finding> findings;
};

/// Reads a folder with stress.jsonl, thresholds.jsonl or both. Throws `Error` (Io, Syntax), also if there is
/// neither.
LimitsData read_limits(const std::string& folder);

/// Converts to lines of JSON, and back. Throws `Error` (Syntax).
std::string to_jsonl(const LimitsData& data);
LimitsData limits_from_jsonl(std::string_view text);

}  // namespace plumb::harness::limits
