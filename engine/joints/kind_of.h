#pragma once

#include "engine/joints/definitions.h"
#include "engine/scene/joint.h"

namespace plumb {

/// Returns the definition of a scene's joint.
JointKind kind_of(const Joint& joint);

}  // namespace plumb
