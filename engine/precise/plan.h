#pragma once

#include "engine/driver/plan.h"
#include "engine/precise/dynamics/scene_partition.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// Indices of the stages in the plan, in the order in which a step runs them.
enum StageIndex : int {
  kContacts,
  kForces,
  kJointAccelerations,
  kRungeKutta,
  kProjection,
  kPolynomialFlight,
  kContactSearch,
  kStageCount,
};

/// Returns the stages that the scene needs, with reasons; `every_stage` activates all of them.
Plan plan_of(const Scene& scene, const ScenePartition& partition, bool every_stage);

}  // namespace plumb::precise
