#pragma once

#include <vector>

#include "harness/sweep/front.h"

namespace plumb::harness::sweep {

/// One engine's points in the order in which they are worth measuring: its front, ends first and then spread
/// over it; then what is a front without that, and so on.
std::vector<Point> by_importance(std::vector<Point> points);

}  // namespace plumb::harness::sweep
