#pragma once

#include <cstdint>
#include <string>

#include "engine/world/world.h"

namespace plumb::harness::hunt {

/// Sends a world random queries (rays, casts, overlaps, nearest shapes, distances) and compares the answers
/// with the outlines of its shapes. Returns the first wrong answer, in one line; empty if there is none.
/// Leaves out sensors and shapes with empty masks, which queries do not see, and chains, which can be hit
/// only from the front.
template <class Real>
std::string wrong_answer(const BasicWorld<Real>& world, std::uint64_t seed);

}  // namespace plumb::harness::hunt
