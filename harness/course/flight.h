#pragma once

#include <optional>
#include <string>

#include "harness/course/lab.h"

namespace plumb::course {

/// A mistake that shows in the motion of a body, without the figures of a check.
struct Seen {
  std::string mistake, says;
  bool general = false;  ///< says which law is wrong and by how much; a named mistake is more specific
};

/// Examines bodies in free flight, until they come near another body, in scenes without joints and with
/// constant forces. Each step then adds the same velocity (g dt without other forces). Detects velocities
/// that are multiplied in each step or limited to a largest speed, and states rounded to decimals. From
/// constant factors, detects wrong step lengths and wrong changes of velocity and position.
std::optional<Seen> seen_in_flight(const Recorded& run);

/// Returns true if no body comes near another and no joint acts: engines of the same method then agree to
/// rounding.
bool flies_freely(const Recorded& run);

}  // namespace plumb::course
