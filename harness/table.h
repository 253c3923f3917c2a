#pragma once

#include <span>
#include <string>
#include <string_view>

#include "harness/result.h"
#include "harness/style.h"

namespace plumb::harness {

/// One instance's results as a table: a row an engine, the best of each column painted, and below it what was
/// missed and why.
std::string table(std::span<const Result> results, const Style& style);

/// `text` as a field of CSV: quoted where it has to be, quotes doubled. Source: RFC 4180.
std::string csv_field(std::string_view text);

/// One line a result; the first line names the columns.
std::string csv_header();
std::string csv_row(const Result& result);

}  // namespace plumb::harness
