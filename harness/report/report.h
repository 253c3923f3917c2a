#pragma once

#include <span>
#include <string>

#include "reference/backend.h"

namespace plumb::harness::report {

/// Writes the report of a folder's results.jsonl, stress.jsonl and thresholds.jsonl, those of them that are
/// there, or of one file of results, to `out`, one HTML file; whole or not at all. What it takes to replay
/// them is run with `engines` and kept in the folder. False, and nothing is written, after an interrupt.
/// Throws `Error` (Io; Syntax; Value where there is no result).
bool write_report(const std::string& folder_or_file, const std::string& out,
                  std::span<const reference::Backend* const> engines);

/// Writes the picture of a folder's stress.jsonl, SVG. Throws `Error` (Io; Syntax; Value where there is
/// none).
void write_extremes_picture(const std::string& folder, const std::string& out);

/// report.html in the folder, or beside the file.
std::string default_report_path(const std::string& folder_or_file);

}  // namespace plumb::harness::report
