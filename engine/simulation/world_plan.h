#pragma once

#include "engine/driver/accuracy.h"
#include "engine/driver/plan.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Indices of the stages in the plan of a world; those between Forces and Monitor are `WorldStage`'s.
inline constexpr std::size_t kForcesStage = 0, kFirstWorldStage = 1;

/// Derives the stages of a step that `scene` needs, with the reasons. With `every_stage`, all stages are
/// active, needed or not. The scene is valid.
Plan plan_world(const Scene& scene, const Realtime& accuracy, bool every_stage);

/// Returns true if the world needs the scene's shapes: shapes of different bodies may touch, or bodies may
/// sleep, because the speed at which a body may sleep depends on its size.
bool needs_shapes(const Plan& plan);

}  // namespace plumb
