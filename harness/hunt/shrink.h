#pragma once

#include <functional>

#include "harness/hunt/case.h"

namespace plumb::harness::hunt {

/// Whether a case still fails as the one that is being made smaller.
using StillFails = std::function<bool(const Case& candidate)>;

/// The smallest case that was found to fail: without bodies, shapes, joints, actions, features and digits
/// that it can do without. Asks at most `most` times, and no longer than `seconds`.
Case shrink(Case one, const StillFails& still_fails, int most = 600, double seconds = 20);

}  // namespace plumb::harness::hunt
