#pragma once

#include "engine/encoding/members.h"
#include "engine/joints/definitions.h"

/// Member lists of the definitions of joints.
namespace plumb {

PLUMB_MEMBERS(Spring, hertz, damping_ratio)
PLUMB_MEMBERS(Range, lower, upper)
PLUMB_MEMBERS(Motor, speed, max_force)
PLUMB_MEMBERS(DistanceDefinition, anchor_a, anchor_b, length, spring, range, motor)
PLUMB_MEMBERS(RevoluteDefinition, anchor_a, anchor_b, reference_angle, limits, motor, spring, target_angle)
PLUMB_MEMBERS(PrismaticDefinition, anchor_a, anchor_b, axis, reference_angle, limits, motor, spring,
              target_translation)
PLUMB_MEMBERS(WeldDefinition, anchor_a, anchor_b, reference_angle, linear_spring, angular_spring)
PLUMB_MEMBERS(WheelDefinition, anchor_a, anchor_b, axis, spring, limits, motor)
PLUMB_MEMBERS(MotorDefinition, target_position, target_angle, max_force, max_torque, spring)
PLUMB_MEMBERS(MouseDefinition, anchor_b, target, spring, max_force)
PLUMB_MEMBERS(GearDefinition, ratio, phase)
PLUMB_MEMBERS(PulleyDefinition, ground_a, ground_b, anchor_a, anchor_b, ratio, length)
PLUMB_MEMBERS(RatchetDefinition, tooth, phase)
PLUMB_MEMBERS(FrictionDefinition, anchor_a, anchor_b, max_force, max_torque)

}  // namespace plumb
