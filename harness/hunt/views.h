#pragma once

#include <cstdint>

#include "harness/hunt/case.h"

/// A case as it looks from elsewhere. What moves has to move the same way there. Cases have no actions.
namespace plumb::harness::hunt {

Case mirrored(Case one);           ///< x becomes -x
Case turned(Case one);             ///< by a right angle, counter-clockwise
Case shifted(Case one, Vec2d by);  ///< m
Case relabelled(Case one);         ///< bodies, shapes and joints in reverse order
Case rescaled(Case one, double length, double time, double mass);  ///< powers of two
/// Every number that moves is off by up to `by` of the size of its body, and as much per second.
Case perturbed(Case one, double by, std::uint64_t seed);

/// A state of the case so seen, seen from where the case stands.
BodyState mirrored(const BodyState& state);
BodyState turned(const BodyState& state);

}  // namespace plumb::harness::hunt
