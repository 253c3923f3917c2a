#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb::precise {

/// Scenes that differ from the given one in one parameter, by -2, -1, 1 and 2 steps.
struct Variation {
  static constexpr std::array<int, 4> kOffsets{-2, -1, 1, 2};
  /// Step as a fraction of the parameter's scale. For motions that vary over that scale, a fourth-order
  /// difference with this step has an error of about 1e-16 by truncation and of 1e-12 by rounding.
  static constexpr double kStep = 2e-4;

  std::string name;  ///< of the parameter
  double step = 0;   ///< in its own unit
  std::array<Scene, kOffsets.size()> scenes{};
  bool initial_only = false;  ///< the parameter changes only the initial state, not the laws of motion
};

/// Returns the variations of `scene` by the numbers that `names` refer to (`numbers_at`). `prepared` is
/// applied to each of them, as it is to the scene for its run. Throws `Error` (Name).
std::vector<Variation> variations_of(const Scene& scene, const std::vector<std::string>& names,
                                     const std::function<Scene(const Scene&)>& prepared);

}  // namespace plumb::precise
