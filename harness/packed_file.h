#pragma once

#include <string>

/// Files of lines that units leave behind, compressed with zstd if plumb is built with it. Lines of results
/// repeat names and settings, so compressed results of all scenes take a tenth of the space.
namespace plumb::harness {

/// Replaces each file "*.jsonl" in `folder` by "*.jsonl.zst", whole or not at all. Skips files that fit into
/// one block of a disk, and all files if plumb is built without zstd. Throws `Error` (Io).
void pack_files(const std::string& folder);

/// Returns true if `path` or its compressed form exists.
bool is_packed_or_plain(const std::string& path);

/// Reads `path` or its compressed form. Of a truncated compressed file it returns the part before the cut.
/// Throws `Error` (Io; Syntax if the file was not written by zstd; Unsupported if plumb is built without
/// zstd).
std::string read_packed_or_plain(const std::string& path);

}  // namespace plumb::harness
