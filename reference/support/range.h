#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace plumb::reference {

/// What an engine's arithmetic can hold: quantities up to `largest`, whose squares must not overflow, and
/// masses, inertias and sizes from `smallest`, whose inverses must not.
struct Range {
  double smallest;
  double largest;
  double smallest_inertia = smallest;  ///< kg m^2
  double largest_inertia = largest;
};

inline constexpr Range kFloatRange{.smallest = 1e-18, .largest = 1e18};
inline constexpr Range kDoubleRange{.smallest = 1e-150, .largest = 1e150};

/// Empty, or which of the scene's quantities is out of `range`, for `Backend::unsupported`.
std::string out_of_range(const Scene& scene, const Range& range);

}  // namespace plumb::reference
