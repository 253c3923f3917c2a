#pragma once

#include <string>

#include "engine/world/recorder.h"
#include "engine/world/world.h"
#include "harness/hunt/random.h"

/// Random calls of a world's interface, as a game makes them between steps.
namespace plumb::harness::hunt {

/// Draws a call for the state of `world` and makes it through `target`: the world itself, or its recorder.
/// Draws the default values of a definition as often as others. Returns a description of the first error
/// afterwards (a getter whose answer differs from the set value, a change of mass that changes the motion, a
/// sleeping body that is not woken, a hash that does not change), or an empty text. Calls that are rejected
/// with an `Error` do not count.
template <class Real, class Target>
std::string make_call(Random& random, const BasicWorld<Real>& world, Target& target);

extern template std::string make_call(Random&, const BasicWorld<float>&, BasicWorld<float>&);
extern template std::string make_call(Random&, const BasicWorld<double>&, BasicWorld<double>&);
extern template std::string make_call(Random&, const BasicWorld<float>&, RecordedWorld<float>&);
extern template std::string make_call(Random&, const BasicWorld<double>&, RecordedWorld<double>&);

}  // namespace plumb::harness::hunt
