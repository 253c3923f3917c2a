#pragma once

#include <optional>
#include <string>

#include "harness/course/lab.h"

namespace plumb::course {

/// A mistake that the motion of a body shows by itself, without the figures of a check.
struct Seen {
  std::string mistake, says;
  bool general = false;  ///< says which law is wrong and by how much; a named cause is more specific
};

/// Examines bodies in free flight: until they come near another one, in a scene without joints whose forces
/// are constant. Each step then adds the same velocity, without forces g dt. Detects velocities that are
/// multiplied in each step or limited to a largest speed, states rounded to decimals and, from constant
/// factors, wrong step lengths and wrong changes of velocity and position.
std::optional<Seen> seen_in_flight(const Recorded& run);

/// Returns true if no body comes near another and no joint acts: engines of the same method then agree to
/// rounding.
bool flies_freely(const Recorded& run);

}  // namespace plumb::course
