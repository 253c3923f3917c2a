#pragma once

#include <string>

#include "harness/hunt/finding.h"
#include "harness/hunt/motion.h"

namespace plumb::harness::hunt {

/// A motion to be drawn.
struct Shown {
  std::string title;
  Motion motion{};
};

/// Draws the motions beside each other as SVG: the bodies at the start (grey) and at the end, and the paths
/// of their centres.
std::string picture(const Case& one, const std::vector<Shown>& motions, const std::string& caption);

}  // namespace plumb::harness::hunt
