#pragma once

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// Checks of chapter 5 on a hinge of one rod or of two.
namespace plumb::course {

Finding hinged_rod(const Lab& lab);

/// Two rods on a hinge, without gravity: one rests, the other turns about the hinge at 3 rad/s. The hinge
/// then turns the first as well; momentum and angular momentum are conserved.
Finding hinge_turns_both(const Lab& lab);

}  // namespace plumb::course
