#pragma once

#include "engine/driver/accuracy.h"
#include "engine/world/recording/definition_members.h"

/// The members of what scenes are made from.
namespace plumb {

PLUMB_MEMBERS(Chain, points, closed)
PLUMB_MEMBERS(Shape, geometry, position, angle, friction, restitution, filter, rolling_resistance,
              surface_speed, density)
PLUMB_MEMBERS(Body, name, type, position, angle, velocity, angular_velocity, mass, inertia, fixed_rotation,
              shapes, gravity_scale, linear_damping, angular_damping, lock_x, lock_y, motion)
PLUMB_MEMBERS(PrescribedMotion, x, y, angle)
PLUMB_MEMBERS(Drive, joint, speed)
PLUMB_MEMBERS(LinearDrag, body, coefficient, angular_coefficient)
PLUMB_MEMBERS(QuadraticDrag, body, coefficient)
PLUMB_MEMBERS(PointForce, body, force, point, frame, start, duration)
PLUMB_MEMBERS(Torque, body, torque, start, duration)
PLUMB_MEMBERS(SpringForce, body_a, body_b, anchor_a, anchor_b, rest_length, stiffness, damping)
PLUMB_MEMBERS(AttractionForce, body, centre_body, centre, strength, exponent)
PLUMB_MEMBERS(SinusoidalForce, body, amplitude, point, angular_frequency, phase)
PLUMB_MEMBERS(FormulaForce, body, x, y, torque, point)
PLUMB_MEMBERS(FormulaSpring, body_a, body_b, anchor_a, anchor_b, tension)
PLUMB_MEMBERS(RevoluteJoint, name, body_a, body_b, anchor_a, anchor_b, collide, break_force, break_torque,
              reference_angle, limits, motor, spring, target_angle)
PLUMB_MEMBERS(DistanceJoint, name, body_a, body_b, anchor_a, anchor_b, length, collide, break_force,
              break_torque, spring, range, motor)
PLUMB_MEMBERS(PrismaticJoint, name, body_a, body_b, anchor_a, anchor_b, collide, break_force, break_torque,
              axis, reference_angle, limits, motor, spring, target_translation)
PLUMB_MEMBERS(WeldJoint, name, body_a, body_b, anchor_a, anchor_b, collide, break_force, break_torque,
              reference_angle, linear_spring, angular_spring)
PLUMB_MEMBERS(WheelJoint, name, body_a, body_b, anchor_a, anchor_b, collide, break_force, break_torque, axis,
              spring, limits, motor)
PLUMB_MEMBERS(MotorJoint, name, body_a, body_b, collide, break_force, break_torque, target_position,
              target_angle, max_force, max_torque, spring)
PLUMB_MEMBERS(MouseJoint, name, body_a, body_b, anchor_b, collide, break_force, break_torque, target, spring,
              max_force)
PLUMB_MEMBERS(GearJoint, name, body_a, body_b, collide, break_force, break_torque, ratio, phase)
PLUMB_MEMBERS(PulleyJoint, name, body_a, body_b, anchor_a, anchor_b, collide, break_force, break_torque,
              ground_a, ground_b, ratio, length)
PLUMB_MEMBERS(RatchetJoint, name, body_a, body_b, collide, break_force, break_torque, tooth, phase)
PLUMB_MEMBERS(FrictionJoint, name, body_a, body_b, anchor_a, anchor_b, collide, break_force, break_torque,
              max_force, max_torque)
PLUMB_MEMBERS(ContactRules, friction, restitution, restitution_threshold, simultaneous, impact, yield_speed,
              tangential_restitution, friction_after_stop, friction_while_sliding)
PLUMB_MEMBERS(Scene, name, gravity, contact_rules, bodies, joints, forces, drives)
PLUMB_MEMBERS(Realtime, dt, substeps, iterations, precision, integrator, solver, continuous, sleeping,
              on_violation, threads)
PLUMB_MEMBERS(Precise, tolerance, max_dt, method, estimate_error)

}  // namespace plumb
