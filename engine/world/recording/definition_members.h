#pragma once

#include "engine/joints/definition_members.h"
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
PLUMB_MEMBERS(ChainDefinition, points, closed, material, filter, sensor, hit_events, pre_solve, user_data,
              materials)
PLUMB_MEMBERS(MassProperties, mass, centre, inertia)
PLUMB_MEMBERS(BodyDefinition, name, type, position, angle, velocity, angular_velocity, mass, gravity_scale,
              linear_damping, angular_damping, lock_x, lock_y, lock_rotation, may_sleep, awake, user_data,
              continuous)

PLUMB_MEMBERS(JointDefinition, kind, collide, break_force, break_torque, user_data, report_force,
              report_torque)

}  // namespace plumb
