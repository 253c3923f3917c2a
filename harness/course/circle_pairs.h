#pragma once

#include "harness/course/lab.h"
#include "harness/course/scenes.h"

/// Runs two circles into each other, and measures how they meet.
namespace plumb::course {

/// Tolerance of a speed after a collision, as a fraction of the closing speed: contacts may be soft.
inline constexpr double kShare = 0.002;

inline constexpr const char* kPulledBack =
    "Two balls that already part get another impulse, and are held together or sent back: answer a contact "
    "only if "
    "(vb - va) . n < 0, and keep the sum of a contact's impulses from becoming negative.";

/// Returns the distance of the centres of the first two bodies in the state number `k`, m.
double distance(const Trace& trace, std::size_t k);

/// Runs two balls without gravity, "a" and "b".
Trace head_on(const Lab& lab, Ball a, Ball b, double duration = 1.5, int finer = 1);

/// Returns the separation speed of two balls on the x axis; negative if they approach.
double parting(const std::vector<BodyState>& states);

/// Returns true if two balls are slowed or reversed after an impulse has separated them.
bool pulled_back(const Trace& trace, double closing);

/// Returns true if two balls that collide without others reverse each other's velocity.
bool two_bounce(const Lab& lab);

}  // namespace plumb::course
