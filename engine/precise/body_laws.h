#pragma once

#include "engine/scene/scene.h"

namespace plumb::precise {

/// Returns the scene with properties of bodies converted to force laws: the difference of `gravity_scale`
/// from 1, and damping as linear drag, v' = -c v. The motion is the same, and the laws have derivatives.
Scene with_body_laws(Scene scene);

}  // namespace plumb::precise
