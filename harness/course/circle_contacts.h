#pragma once

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// Checks of chapter 3 on contacts: static circles, overlaps, and more than two circles.
namespace plumb::course {

Finding post(const Lab& lab);
Finding overlap_is_shared(const Lab& lab);
Finding break_shot(const Lab& lab);
Finding pile_rests(const Lab& lab);

}  // namespace plumb::course
