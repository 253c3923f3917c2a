#pragma once

#include <string>

/// Files of lines that units leave behind: compressed with zstd where plumb is built with it. Lines of
/// results repeat names and settings: the comparison of all scenes takes a tenth of its room.
namespace plumb::harness {

/// Replaces each file "*.jsonl" in `folder` by "*.jsonl.zst", whole or not at all. Leaves alone what fits
/// into one block of a disk, and everything where plumb is built without zstd. Throws `Error` (Io).
void pack_files(const std::string& folder);

/// Returns true if `path` is there, or its compressed form.
bool is_packed_or_plain(const std::string& path);

/// Reads `path` or its compressed form. Of one that was cut short it returns what comes before the cut.
/// Throws `Error` (Io; Syntax if it is not what zstd wrote; Unsupported where plumb is built without zstd).
std::string read_packed_or_plain(const std::string& path);

}  // namespace plumb::harness
