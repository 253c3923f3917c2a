#pragma once

#include <string>

#include "harness/hunt/finding.h"
#include "harness/hunt/motion.h"

namespace plumb::harness::hunt {

/// A motion as it goes into a picture.
struct Shown {
  std::string title;
  Motion motion{};
};

/// The motions side by side as SVG: where the bodies start (grey), the paths of their centres, and where they
/// end.
std::string picture(const Case& one, const std::vector<Shown>& motions, const std::string& caption);

}  // namespace plumb::harness::hunt
