#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb::harness {

/// All names that `needs_of` uses, in its order: shapes, joints ("revolute joint") and forces (with "spring
/// force" for a spring) as the scene format calls them, then features.
const std::vector<std::string>& all_needs();

/// Returns what an engine needs to run `scene`: the kinds of its shapes, joints and forces, and "contacts",
/// "friction", "restitution", "filters", "kinematic", "fixed_rotation", "locked_axes", "damping",
/// "gravity_scale", "rolling_resistance", "surface_speed", "limits", "motors", "springs" (of joints). Leaves
/// out shapes that cannot touch anything.
std::vector<std::string> needs_of(const Scene& scene);

}  // namespace plumb::harness
