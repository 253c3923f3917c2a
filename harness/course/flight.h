#pragma once

#include <optional>
#include <string>

#include "harness/course/lab.h"

namespace plumb::course {

/// A mistake that the motion of a body shows by itself, without the figures of a check.
struct Seen {
  std::string mistake, says;
};

/// Looks at bodies in free flight: until they come near another one, in a scene without forces and joints.
/// Each step then adds g dt to their velocity. Finds velocities that are multiplied in each step or held at a
/// largest speed, and states that are rounded to decimals.
std::optional<Seen> seen_in_flight(const Recorded& run);

/// Returns true if no body comes near another and no joint acts: engines of one method then agree to
/// rounding.
bool flies_freely(const Recorded& run);

}  // namespace plumb::course
