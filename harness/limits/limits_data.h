#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/report/extremes.h"
#include "harness/thresholds/finding.h"

/// What docs/limits.md is written from: the results of `plumb stress` and `plumb thresholds`, without what
/// differs from run to run.
namespace plumb::harness::limits {

/// One engine with one setting on one family.
struct FamilyRow {
  std::string family, title, axis, unit, engine, setting;
  std::vector<double> values{};         ///< of the axis, ascending
  std::vector<std::string> outcomes{};  ///< as many
  std::vector<std::string> reasons{};   ///< as many; empty but where what survives ends

  /// The longest run of values that survive, first and one past the last; equal where none does.
  std::pair<std::size_t, std::size_t> survived_range() const;
  std::size_t survived() const;
  bool skipped() const;  ///< the engine does not have what the family needs
};

struct LimitsData {
  std::string measured;  ///< "plumb 0.1.0, commit abc, on CPU"; empty where it is not known
  std::vector<FamilyRow> rows;
  std::vector<thresholds::Finding> findings;
};

/// Of a folder with stress.jsonl, thresholds.jsonl or both. Throws `Error` (Io, Syntax), also where there is
/// neither.
LimitsData read_limits(const std::string& folder);

/// As lines of JSON, and back. Throws `Error` (Syntax).
std::string to_jsonl(const LimitsData& data);
LimitsData limits_from_jsonl(std::string_view text);

}  // namespace plumb::harness::limits
