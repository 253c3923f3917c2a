#pragma once

#include "engine/scene/scene.h"
#include "engine/simulation/plan.h"
#include "engine/simulation/precise_parts.h"

namespace plumb::precise {

/// The stages in the order in which a step runs them: their places in the plan.
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

/// Which stages the scene needs, and why; `every_stage` switches all of them on.
Plan plan_of(const Scene& scene, const Parts& parts, bool every_stage);

}  // namespace plumb::precise
