#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "harness/result.h"
#include "reference/backend.h"

namespace plumb::harness::report {

/// Reads from a file or folder of results only the runs that `replays_of` chooses. Reading all would be slow:
/// each replay is a process forked from this one, which takes long if a million runs are in memory.
std::vector<Result> rows_to_replay(const std::string& folder_or_file);

/// Repeats for each scene and engine the run in `rows` with the step nearest to 1/60 s. Each has a process of
/// its own and at most `seconds`. Returns JSON by `sweep::key_of`: times, poses, and the errors and energy
/// drifts since the time before (docs/formats.md). Replays are cached in `folder`/replays.jsonl and reused
/// while the run is the same. `engines` are those that can be started; others have no replay.
std::map<std::string, std::string> replays_of(std::span<const Result> rows,
                                              std::span<const reference::Backend* const> engines,
                                              const std::string& folder, double seconds = 20);

}  // namespace plumb::harness::report
