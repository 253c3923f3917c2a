#pragma once

#include <vector>

#include "engine/world/world.h"

namespace plumb {

/// Handles of a scene's parts in a world, in the scene's order.
struct SceneParts {
  std::vector<BodyId> bodies;
  std::vector<JointId> joints;
  BodyId frame{};  ///< static body for joints to the world; invalid if there are no such joints
};

/// Returns a definition with the gravity and the combine rules of `scene`.
WorldDefinition world_definition(const Scene& scene);

/// Adds the bodies and joints of a scene to a world, but not its force laws: `SceneForces` (scene_forces.h)
/// applies these before each step. Throws Error as `validate(scene)` does, Error (Value) for numbers beyond
/// the world's limits, and Error (Unsupported) for features that `world_unsupported` names; the world is then
/// unchanged.
template <class Real>
SceneParts add_scene(BasicWorld<Real>& world, const Scene& scene);

/// Throws Error (Value) if a valid scene has numbers beyond the limits of a world in `Real`.
template <class Real>
void require_in_range(const Scene& scene);

/// Returns the feature of a valid scene that no world supports, or an empty string.
std::string world_unsupported(const Scene& scene);

}  // namespace plumb
