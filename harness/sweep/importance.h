#pragma once

#include <vector>

#include "harness/sweep/front.h"

namespace plumb::harness::sweep {

/// Sorts one engine's points by the benefit of measuring them. Its front comes first: the ends, then points
/// spread over it. Then comes the front of the remaining points, and so on.
std::vector<Point> by_importance(std::vector<Point> points);

}  // namespace plumb::harness::sweep
