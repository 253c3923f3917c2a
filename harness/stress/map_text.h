#pragma once

#include <span>
#include <string>

#include "harness/stress/cell.h"
#include "harness/stress/family.h"
#include "harness/style.h"

namespace plumb::harness::stress {

/// Returns a family's cells as a table: one row per engine and setting, one column per value.
std::string map_text(const Family& family, std::span<const Cell> cells, const Style& style);

/// Returns the meaning of the words in the tables.
std::string legend(const Style& style);

/// Returns how many cells each engine survived, by setting and in any setting.
std::string survival_text(std::span<const Cell> cells, const Style& style);

/// Formats a value of an axis in few characters: "0.01", "1e+06" as "1e6", "1/60".
std::string value_text(double value);

}  // namespace plumb::harness::stress
