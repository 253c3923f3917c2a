#pragma once

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// Checks of chapter 5 on a whole ragdoll: a head, a torso and limbs on hinges.
namespace plumb::course {

/// Checks a ragdoll in free flight: its centre of mass falls as a point mass, and its spin stays constant.
Finding ragdoll_flies(const Lab& lab);

/// Checks a ragdoll dropped on the ground: its joints hold and it comes to rest.
Finding ragdoll_drops(const Lab& lab);

}  // namespace plumb::course
