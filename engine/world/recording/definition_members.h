#pragma once

#include "engine/world/definitions.h"
#include "engine/world/snapshot/world_members.h"

/// Member lists of the definitions that worlds are made from.
namespace plumb {

PLUMB_MEMBERS(Circle, radius)
PLUMB_MEMBERS(Box, width, height)
PLUMB_MEMBERS(Capsule, start, end, radius)
PLUMB_MEMBERS(Polygon, points, radius)
PLUMB_MEMBERS(Segment, start, end)
PLUMB_MEMBERS(Material, friction, restitution, rolling_resistance, surface_speed)
PLUMB_MEMBERS(ShapeDefinition, geometry, position, angle, density, material, filter, sensor, hit_events,
              pre_solve, user_data)
PLUMB_MEMBERS(ChainDefinition, points, closed, material, filter, sensor, hit_events, pre_solve, user_data)
PLUMB_MEMBERS(MassProperties, mass, centre, inertia)
PLUMB_MEMBERS(BodyDefinition, name, type, position, angle, velocity, angular_velocity, mass, gravity_scale,
              linear_damping, angular_damping, lock_x, lock_y, lock_rotation, may_sleep, awake, user_data,
              continuous)

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
PLUMB_MEMBERS(JointDefinition, kind, collide, break_force, break_torque, user_data, report_force,
              report_torque)

}  // namespace plumb
