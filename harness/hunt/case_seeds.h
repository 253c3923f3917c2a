#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/hunt/case.h"
#include "harness/hunt/objection.h"

/// Case files (docs/cases.md) as the seeds of a hunt: their scenes, and variations of them.
namespace plumb::harness::hunt {

struct CaseSeed {
  std::string path, name;
  Scene scene{};
  double duration = 1;  ///< s
};

/// Throws as `case_file::read_case`.
CaseSeed read_seed(const std::string& path);

/// Draws case `index` of a hunt among `seeds`, which must not be empty. Each seed comes first unchanged. Then
/// come two kinds of variations: finer steps and sleep, for which the file's expectations still apply; and
/// other masses, materials, positions, frames and disturbances, for which only the laws apply. The same
/// arguments give the same case on every machine.
Case vary(std::uint64_t seed, std::uint64_t index, const std::vector<CaseSeed>& seeds);

/// Judges the engine by the expectations of the case's file if its scene is the file's; otherwise returns
/// nullopt.
Verdict case_file_verdict(const Case& one, const Engine& engine);

}  // namespace plumb::harness::hunt
