#pragma once

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// The checks of chapter 5 that a whole figure takes: a head, a torso and limbs on hinges.
namespace plumb::course {

/// In the air: its centre of mass falls as a stone does, and its spin stays.
Finding ragdoll_flies(const Lab& lab);

/// On the ground: it holds together and settles.
Finding ragdoll_drops(const Lab& lab);

}  // namespace plumb::course
