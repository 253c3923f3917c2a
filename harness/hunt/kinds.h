#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/hunt/hunt.h"

namespace plumb::harness::hunt {

/// A finding with the number of its scene.
struct Found {
  std::uint64_t scene = 0;
  Finding finding{};
};

/// Returns judge, engine and structure: the key known before a finding is shrunk.
std::string coarse_key(const Finding& finding);

/// Groups findings by the common parts of their smallest scenes. Findings that were not shrunk count for the
/// first kind of their judge, engine and structure.
std::vector<Kind> kinds_of(const std::vector<Found>& findings);

}  // namespace plumb::harness::hunt
