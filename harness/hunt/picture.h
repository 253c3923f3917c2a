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

/// Draws the motions side by side as SVG: the bodies' start (grey), the paths of their centres, and their
/// end.
std::string picture(const Case& one, const std::vector<Shown>& motions, const std::string& caption);

}  // namespace plumb::harness::hunt
