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

/// Adds the bodies and joints of a scene to a world. Force laws act step by step: apply them before each step
/// (force_laws.h). Throws Error as `validate(scene)`, and Error (Unsupported) for a scene with force laws or
/// a restitution threshold; nothing has changed then.
template <class Real>
SceneParts add_scene(BasicWorld<Real>& world, const Scene& scene);

}  // namespace plumb
