#pragma once

#include <span>
#include <string>

#include "harness/stress/cell.h"
#include "harness/stress/family.h"
#include "harness/style.h"

namespace plumb::harness::stress {

/// A family's cells: a row an engine and setting, a column a value, a word an outcome.
std::string map_text(const Family& family, std::span<const Cell> cells, const Style& style);

/// What the words in maps mean.
std::string legend(const Style& style);

/// How many cells each engine survived, by setting and in any setting.
std::string survival_text(std::span<const Cell> cells, const Style& style);

/// A value of an axis in few letters: "0.01", "1e+06" as "1e6", "1/60".
std::string value_text(double value);

}  // namespace plumb::harness::stress
