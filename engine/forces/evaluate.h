#pragma once

#include "engine/forces/wrench.h"
#include "engine/scene/scene.h"

namespace plumb {

/// One law's wrench on its body in `state`, averaged over [t0, t1] where the law is switched: for engines
/// that have no such law of their own and take a force and a torque a step.
Wrench<double> evaluate(const ForceLaw& law, const BodyState& state, double t0, double t1);

}  // namespace plumb
