#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace plumb::reference {

/// Range of an engine's arithmetic. Squares of quantities up to `largest` must not overflow, and neither must
/// inverses of masses, inertias and sizes from `smallest` on.
struct Range {
  double smallest;
  double largest;
  double smallest_inertia = smallest;  ///< kg m^2
  double largest_inertia = largest;
};

inline constexpr Range kFloatRange{.smallest = 1e-18, .largest = 1e18};
inline constexpr Range kDoubleRange{.smallest = 1e-150, .largest = 1e150};

/// Returns the reason if one of the scene's quantities is out of `range`; otherwise an empty text. For
/// `Backend::unsupported`.
std::string out_of_range(const Scene& scene, const Range& range);

}  // namespace plumb::reference
