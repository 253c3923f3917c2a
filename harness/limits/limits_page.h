#pragma once

#include <string>
#include <string_view>

#include "harness/limits/limits_data.h"

namespace plumb::harness::limits {

/// The measured part of docs/limits.md, in Markdown.
std::string measured_part(const LimitsData& data);

inline constexpr std::string_view kBegin =
    "<!-- measured: begin. Written by `plumb limits`, not by hand. -->\n";
inline constexpr std::string_view kEnd = "<!-- measured: end -->\n";

/// `page` with `part` between the markers. Throws `Error` (Syntax) where they are not there once each, in
/// order.
std::string with_measured_part(std::string_view page, std::string_view part);

/// What is between the markers now. Throws likewise.
std::string measured_part_of(std::string_view page);

}  // namespace plumb::harness::limits
