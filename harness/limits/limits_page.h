#pragma once

#include <string>
#include <string_view>

#include "harness/limits/limits_data.h"

namespace plumb::harness::limits {

/// Returns the measured part of docs/limits.md, in Markdown.
std::string measured_part(const LimitsData& data);

inline constexpr std::string_view kBegin =
    "<!-- measured: begin. Written by `plumb limits`, not by hand. -->\n";
inline constexpr std::string_view kEnd = "<!-- measured: end -->\n";

/// Returns `page` with `part` between the markers. Throws `Error` (Syntax) unless each marker occurs once, in
/// order.
std::string with_measured_part(std::string_view page, std::string_view part);

/// Returns the present text between the markers. Throws as `with_measured_part` does.
std::string measured_part_of(std::string_view page);

}  // namespace plumb::harness::limits
