#pragma once

#include <span>
#include <string>

#include "reference/backend.h"

namespace plumb::harness::report {

/// Writes the report of a folder's results.jsonl to `out`, one HTML file; whole or not at all. What it takes
/// to replay them is run with `engines` and kept in the folder. False, and nothing is written, after an
/// interrupt. Throws `Error` (Io; Syntax; Value where there is no result).
bool write_report(const std::string& folder_or_file, const std::string& out,
                  std::span<const reference::Backend* const> engines);

/// report.html in the folder, or beside the file.
std::string default_report_path(const std::string& folder_or_file);

}  // namespace plumb::harness::report
