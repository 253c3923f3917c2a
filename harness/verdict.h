#pragma once

#include <span>
#include <string>

#include "harness/result.h"
#include "harness/style.h"

namespace plumb::harness {

/// Verdict on one run.
enum class Ruling {
  Agrees,       ///< every check is within its bound
  Misses,       ///< a check is outside its bound, or the run diverged
  Broke,        ///< the engine reported an error, crashed or hung
  Unsupported,  ///< the engine lacks a feature that the scene needs
  NotReached,   ///< time ran out before it
};
std::string_view name_of(Ruling ruling);
Ruling ruling_on(const Result& result);

/// Numbers of rulings in a set of results.
struct Score {
  int agrees = 0, misses = 0, broke = 0, unsupported = 0, not_reached = 0;
  int judged() const { return agrees + misses + broke; }
};
Score score_of(std::span<const Result> results);

/// Reason for a run that was not made because time ran out.
inline constexpr const char* kOutOfTime = "no time was left";

/// Returns a line per case: first the misses with their sizes, then runs that broke, that agree, and that
/// were not made.
std::string verdict_text(std::span<const Result> results, const Style& style);

/// Returns the same as JSON, with each case's checks.
std::string verdict_json(std::span<const Result> results);

/// Returns a badge as SVG: "physics | 120 of 133 agree".
std::string verdict_badge(std::span<const Result> results);

}  // namespace plumb::harness
