#pragma once

#include <cstdint>

#include "harness/hunt/case.h"

/// Transformations of a case under which its motion must transform in the same way. Cases have no actions.
namespace plumb::harness::hunt {

Case mirrored(Case one);           ///< x becomes -x
Case turned(Case one);             ///< by a right angle, counter-clockwise
Case shifted(Case one, Vec2d by);  ///< m
Case relabelled(Case one);         ///< bodies, shapes and joints in reverse order
Case rescaled(Case one, double length, double time, double mass);  ///< powers of two
/// Perturbs each dynamic body: its position by up to `by` of its size, its angle by up to `by` rad, and its
/// velocities by as much per second.
Case perturbed(Case one, double by, std::uint64_t seed);

/// Transforms a state of the transformed case back.
BodyState mirrored(const BodyState& state);
BodyState turned(const BodyState& state);

}  // namespace plumb::harness::hunt
