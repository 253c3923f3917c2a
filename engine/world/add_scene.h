#pragma once

#include <vector>

#include "engine/world/world.h"

namespace plumb {

/// What a scene became in a world, in the scene's order.
struct SceneParts {
  std::vector<BodyId> bodies;
  std::vector<JointId> joints;
  BodyId frame{};  ///< stands for the fixed frame that joints hold on to; names nothing when none does
};

/// The world that behaves as `scene` says: its gravity, its combine rules.
WorldDefinition world_definition(const Scene& scene);

/// Adds the bodies and joints of a scene to a world. Force laws act step by step: `SceneForces`
/// (scene_forces.h) applies them before each. Throws Error as `validate(scene)`, Error (Value) for numbers
/// beyond the world's own, and Error (Unsupported) as `world_unsupported`; nothing has changed then.
template <class Real>
SceneParts add_scene(BasicWorld<Real>& world, const Scene& scene);

/// Empty, or what of a valid scene no world has.
std::string world_unsupported(const Scene& scene);

}  // namespace plumb
