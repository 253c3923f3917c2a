#pragma once

#include <vector>

#include "harness/sweep/front.h"

namespace plumb::harness::sweep {

/// Sorts one engine's points by the benefit of measuring them: its front, ends first and then spread over it.
/// The front of the remaining points follows, and so on.
std::vector<Point> by_importance(std::vector<Point> points);

}  // namespace plumb::harness::sweep
