#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/result.h"

namespace plumb::harness::sweep {

/// What a row is of: scene, engine and everything that was asked of it. Two rows with one key are the same
/// run measured twice.
std::string key_of(const Result& row);

/// The rows of one scene together, scenes in the order in which they first appear.
std::vector<std::vector<Result>> by_label(std::span<const Result> rows);

/// The engines, in the order in which they first appear.
std::vector<std::string> engines_of(std::span<const Result> rows);

/// Of rows with the same key, the last.
std::vector<Result> latest(std::vector<Result> rows);

/// The latest rows of a file of results, or of `results.jsonl` in a folder. A last line that was cut short is
/// passed over. Throws `Error` (Io, Syntax) that names file and line.
std::vector<Result> read_rows(const std::string& folder_or_file);

/// Whether something that `read_rows` reads is there.
bool holds_rows(const std::string& folder_or_file);

}  // namespace plumb::harness::sweep
