#pragma once

#include <span>
#include <string>

#include "harness/style.h"
#include "harness/thresholds/finding.h"

namespace plumb::harness::thresholds {

/// Formats findings: one block per threshold, one row per engine with found value, exact value and relative
/// difference. Findings of one threshold must be adjacent.
std::string finding_table(std::span<const Finding> findings, const Style& style);

/// Formats the found value to its significant digits: "0.364", "none up to 1e+08", "not even 1", "0.35 to
/// 0.39, not clear". Empty if it was refused.
std::string found_text(const Finding& finding);

/// Formats `value` in `digits` significant digits with its unit.
std::string value_text(double value, int digits, const std::string& unit);

}  // namespace plumb::harness::thresholds
