#pragma once

#include "engine/joints/definitions.h"
#include "engine/scene/joint.h"

namespace plumb {

/// What the joint of a scene is made from.
JointKind kind_of(const Joint& joint);

}  // namespace plumb
