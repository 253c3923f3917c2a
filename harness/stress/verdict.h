#pragma once

#include <string_view>

namespace plumb::harness::stress {

/// Outcome of an engine on a scene, from good to bad.
enum class Verdict {
  Ok,          ///< accurate enough to use: within the family's bounds
  Inaccurate,  ///< plausible, but off by up to ten times its bound
  Drifts,      ///< position or energy drifts slowly
  Sinks,       ///< shapes penetrate each other
  Stretches,   ///< joints are pulled apart
  Freezes,     ///< lost motion that it should have kept
  Tunnels,     ///< reached a place behind a wall
  Explodes,    ///< bodies fly off, or energy grows without bound
  NotFinite,   ///< a non-finite state: "NaN"
  Crashed,     ///< its process died, or ran out of memory
  Timeout,     ///< did not end within the time limit of a cell
  Refused,     ///< the engine declined with a message, before or during the run
  Skipped,     ///< lacks a feature that the family always needs: not counted
};

inline constexpr int kVerdicts = static_cast<int>(Verdict::Skipped) + 1;

std::string_view name_of(Verdict verdict);        ///< "ok", ..., "NaN", ...
std::string_view short_name_of(Verdict verdict);  ///< at most 6 letters, for tables
std::string_view meaning_of(Verdict verdict);     ///< for legends

/// Returns the verdict with this name. Throws `Error` (Name).
Verdict verdict_of(std::string_view name);

}  // namespace plumb::harness::stress
