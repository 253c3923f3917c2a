#pragma once

#include <span>
#include <string>

#include "harness/style.h"
#include "harness/thresholds/finding.h"

namespace plumb::harness::thresholds {

/// Findings for people: a block a threshold, an engine a row with what was found, the exact value and the
/// relative difference. Findings of one threshold stand together.
std::string finding_table(std::span<const Finding> findings, const Style& style);

/// What was found, in the digits that it has: "0.364", "none up to 1e+08", "not even 1", "0.35 to 0.39, not
/// clear". Empty where it was refused.
std::string found_text(const Finding& finding);

/// `value` in `digits` significant digits and its unit.
std::string value_text(double value, int digits, const std::string& unit);

}  // namespace plumb::harness::thresholds
