#pragma once

#include <string>
#include <vector>

#include "harness/hunt/objection.h"

namespace plumb::harness::hunt {

/// Result of one case on one engine.
struct Examined {
  std::vector<Objection> objections{};  ///< at most one per judge
  std::string skipped{};                ///< reason why the engine rejected the case
};

/// Runs `one` and evaluates every judge, or only that of `law`.
Examined examine(const Engine& engine, const Case& one, const std::string& law = "");

/// Returns the names of all judges, in the order of evaluation.
std::vector<std::string> judge_names();

}  // namespace plumb::harness::hunt
