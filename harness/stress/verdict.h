#pragma once

#include <string_view>

namespace plumb::harness::stress {

/// What became of an engine on a scene, from good to bad.
enum class Verdict {
  Ok,          ///< right enough to use: within the family's bounds
  Inaccurate,  ///< sane, but off by more than its bound, at most ten times
  Drifts,      ///< leaves its place or its energy, slowly
  Sinks,       ///< shapes lie in each other
  Stretches,   ///< joints are open
  Freezes,     ///< what should move has lost its motion
  Tunnels,     ///< is where it could only get through a wall
  Explodes,    ///< flies off, or gains energy without bound
  NotFinite,   ///< a state that is not finite: "NaN"
  Crashed,     ///< its process died, or had no memory left
  Timeout,     ///< no end within the time of a cell
  Refused,     ///< said that it cannot, with a sentence, before or in the run
  Skipped,     ///< lacks what the family needs at any value: not counted
};

inline constexpr int kVerdicts = static_cast<int>(Verdict::Skipped) + 1;

std::string_view name_of(Verdict verdict);        ///< "ok", ..., "NaN", ...
std::string_view short_name_of(Verdict verdict);  ///< at most 6 letters, for tables
std::string_view meaning_of(Verdict verdict);     ///< for legends

/// Throws `Error` (Name).
Verdict verdict_of(std::string_view name);

}  // namespace plumb::harness::stress
