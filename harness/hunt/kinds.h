#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/hunt/hunt.h"

namespace plumb::harness::hunt {

/// A finding and the scene that showed it.
struct Found {
  std::uint64_t scene = 0;
  Finding finding{};
};

/// Judge, engine and structure: what is known before a finding is made smaller.
std::string coarse_key(const Finding& finding);

/// Groups findings by what their smallest scenes have in common; those that were not made smaller count for
/// the first kind of their judge, engine and structure.
std::vector<Kind> kinds_of(const std::vector<Found>& findings);

}  // namespace plumb::harness::hunt
