#pragma once

#include "engine/scene/scene.h"

namespace plumb::precise {

/// Returns the scene with what its bodies ask for as force laws: the part of gravity that `gravity_scale`
/// leaves out or adds, and damping as linear drag, v' = -c v. The motion is the same, and its laws have
/// derivatives.
Scene with_body_laws(Scene scene);

}  // namespace plumb::precise
