#pragma once

#include <cstddef>
#include <vector>

#include "harness/course/course.h"

namespace plumb::course {

/// Names failed checks that have no name by a mistake that a later check has shown. A check is named if the
/// learner's engine, with that mistake, gives its readings. If it only fails the check as well, the check
/// says so, without a name. Leaves the first `told` outcomes as they are.
void name_in_hindsight(const Lab& lab, std::vector<Outcome>& outcomes, std::size_t told);

}  // namespace plumb::course
