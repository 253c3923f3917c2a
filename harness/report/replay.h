#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "harness/result.h"
#include "reference/backend.h"

namespace plumb::harness::report {

/// Runs again what `rows` say, one run an engine of each scene: the one whose step is nearest to 1/60 s. Each
/// run has a process of its own and at most `seconds`. Gives JSON by `sweep::key_of`: times, poses, and the
/// errors and energy drifts since the time before, as docs/formats.md has them. Kept in
/// `folder`/replays.jsonl, and taken from there where the run is the same. `engines` are those that can be
/// started; others have no replay.
std::map<std::string, std::string> replays_of(std::span<const Result> rows,
                                              std::span<const reference::Backend* const> engines,
                                              const std::string& folder, double seconds = 20);

}  // namespace plumb::harness::report
