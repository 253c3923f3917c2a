#pragma once

#include <cstddef>
#include <vector>

#include "engine/forces/evaluate.h"
#include "engine/scene/scene.h"

namespace plumb::reference {

/// A force law and the index of the body that it acts on.
struct AppliedForce {
  std::size_t body;
  ForceLaw law;
};

/// The scene's force laws for an engine that takes a force and a torque a step: `evaluate` gives them.
std::vector<AppliedForce> applied_forces(const Scene& scene);

}  // namespace plumb::reference
