#pragma once

#include "engine/scene/scene.h"

namespace plumb {

/// Throws `Error` (Value or Name) for the first thing in `scene` that no engine could run. Examples are a
/// non-finite value or one out of its range; an empty, reserved, duplicate or unknown name; a joint of a body
/// to itself; a dynamic body without rotational inertia. Does not change the scene.
void validate(const Scene& scene);

}  // namespace plumb
