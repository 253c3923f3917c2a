#pragma once

#include <span>
#include <string>
#include <string_view>

#include "harness/result.h"
#include "harness/style.h"

namespace plumb::harness {

/// Formats one instance's results: one row per engine, the best of each column coloured, and below them the
/// missed bounds with reasons.
std::string table(std::span<const Result> results, const Style& style);

/// Returns `text` as a field of CSV: quoted if necessary, quotes doubled. Source: RFC 4180.
std::string csv_field(std::string_view text);

/// Formats results as CSV, one line each; the header names the columns.
std::string csv_header();
std::string csv_row(const Result& result);

}  // namespace plumb::harness
