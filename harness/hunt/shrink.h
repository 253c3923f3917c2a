#pragma once

#include <functional>

#include "harness/hunt/case.h"

namespace plumb::harness::hunt {

/// Returns true if a candidate still fails as the original case does.
using StillFails = std::function<bool(const Case& candidate)>;

/// Returns the smallest failing case that was found, without the bodies, shapes, joints, actions, features
/// and digits that are not needed. Tests at most `most` candidates, for at most `seconds`.
Case shrink(Case one, const StillFails& still_fails, int most = 600, double seconds = 20);

}  // namespace plumb::harness::hunt
