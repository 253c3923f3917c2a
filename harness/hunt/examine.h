#pragma once

#include <string>
#include <vector>

#include "harness/hunt/objection.h"

namespace plumb::harness::hunt {

/// What one case on one engine came to.
struct Examined {
  std::vector<Objection> objections{};  ///< one a judge at most
  std::string skipped{};                ///< why the engine did not take it
};

/// Runs `one` and asks every judge, or only that of `law`.
Examined examine(const Engine& engine, const Case& one, const std::string& law = "");

/// The names of all judges, in the order in which they are asked.
std::vector<std::string> judge_names();

}  // namespace plumb::harness::hunt
