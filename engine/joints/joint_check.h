#pragma once

#include "engine/joints/definitions.h"

namespace plumb {

/// Throws Error (Value), which names the joint and the field, if no joint can be made from the definition.
void validate(const JointKind& definition);

/// Returns "distance joint", "revolute joint", ...
const char* name_of(const JointKind& definition);

}  // namespace plumb
