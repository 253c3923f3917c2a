#pragma once

#include "engine/scene/scene.h"

namespace plumb {

/// Throws `Error` (Value or Name) for the first thing in `scene` that no engine could run, and changes
/// nothing. Such are a non-finite value or one out of its range; an empty, reserved, duplicate or unknown
/// name; a joint of a body to itself; a dynamic body without rotational inertia.
void validate(const Scene& scene);

}  // namespace plumb
