#pragma once

#include "engine/scene/scene.h"

namespace plumb {

/// Throws `Error` (Value or Name) for the first thing in `scene` that no engine could run: a value that is
/// not finite or out of its range, an empty, reserved, duplicate or unknown name, a joint of a body to
/// itself, a dynamic body without rotational inertia. Nothing is changed.
void validate(const Scene& scene);

}  // namespace plumb
