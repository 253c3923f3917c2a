#pragma once

#include "engine/encoding/members.h"
#include "engine/precise/dynamics/ballistic_motion.h"
#include "engine/precise/event_search/conservative_advancement.h"
#include "engine/precise/events/contacts.h"

/// Member lists of the structs in snapshots of a precise run.
namespace plumb {

template <>
inline constexpr int kEnumerators<precise::Feature::Kind> = 3;
template <>
inline constexpr int kEnumerators<precise::Contacts::Guard::Kind> = 4;

PLUMB_MEMBERS(BodyState, position, angle, velocity, angular_velocity)
PLUMB_MEMBERS(EventCount, count, last)
PLUMB_MEMBERS(precise::Motion, state, acceleration, angular_acceleration)
PLUMB_MEMBERS(precise::BallisticMotion::Arc, start, motion)
PLUMB_MEMBERS(precise::ShapePair, a, b)
PLUMB_MEMBERS(precise::Feature, kind, a, b)
PLUMB_MEMBERS(precise::Contacts::Guard, kind, pair, feature, limit_motor, patch, monitored, point)

}  // namespace plumb
