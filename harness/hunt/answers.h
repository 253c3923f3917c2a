#pragma once

#include <cstdint>
#include <string>

#include "engine/world/world.h"

namespace plumb::harness::hunt {

/// Asks a world random queries (rays, casts, overlaps, nearest shapes, distances) and holds the answers
/// against the outlines of its shapes. Returns the first that is wrong, in one line; empty if there is none.
/// Left out are sensors and empty masks, which queries do not see, and chains, of which only the front can be
/// met.
template <class Real>
std::string wrong_answer(const BasicWorld<Real>& world, std::uint64_t seed);

}  // namespace plumb::harness::hunt
