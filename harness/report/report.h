#pragma once

#include <span>
#include <string>

#include "reference/backend.h"

namespace plumb::harness::report {

/// Writes the report to `out`, one HTML file, completely or not at all. Its data are a folder's
/// results.jsonl, stress.jsonl and thresholds.jsonl, as far as they exist, or one file of results. Replays
/// are run with `engines` and kept in the folder. Returns false, and writes nothing, after an interrupt.
/// Throws `Error` (Io; Syntax; Value if there is no result).
bool write_report(const std::string& folder_or_file, const std::string& out,
                  std::span<const reference::Backend* const> engines);

/// Draws a folder's stress.jsonl as SVG. Throws `Error` (Io; Syntax; Value if there is none).
void write_extremes_picture(const std::string& folder, const std::string& out);

/// Returns the report's path: report.html in the folder, or beside the file.
std::string default_report_path(const std::string& folder_or_file);

}  // namespace plumb::harness::report
