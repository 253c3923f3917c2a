#pragma once

#include <span>

#include "engine/scene/scene.h"

namespace plumb {

/// Returns the potential energy of the scene's conservative force laws (springs, attractions) in `states`, J.
/// Gravity, damping and laws that depend on time or velocity are not part of it. The scene is valid.
double potential_energy(const Scene& scene, std::span<const BodyState> states);

}  // namespace plumb
