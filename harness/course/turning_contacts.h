#pragma once

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// Checks of chapter 4 on bodies that turn and touch.
namespace plumb::course {

/// Describes the mistake of a lever arm that starts at the origin, which checks of forces and of impacts
/// detect.
inline constexpr const char* kLever =
    "The arm r is measured from the world's origin: measure it from the body's centre to the point.";

/// Checks a ball that hits a rod off-centre.
Finding ball_hits_rod(const Lab& lab);

/// Checks a ball that bounces off the sides of a static box that is turned.
Finding turned_box(const Lab& lab);

/// Checks a box that lands flat, on both corners, and bounces flat.
Finding lands_flat(const Lab& lab);

/// Checks a flat box that friction slows by mu g.
Finding slides(const Lab& lab);

/// Checks a box that comes to rest on the ground and stays.
Finding box_rests(const Lab& lab);

/// Checks the friction between two discs, one of which spins.
Finding discs_rub(const Lab& lab);

}  // namespace plumb::course
