#pragma once

#include <tuple>

#include "engine/encoding/members.h"
#include "engine/world/world_data.h"

/// Member lists of a world's data types.
namespace plumb {

template <>
inline constexpr int kEnumerators<BodyType> = 3;
template <>
inline constexpr int kEnumerators<Combine> = 5;
template <>
inline constexpr int kEnumerators<Solver> = 5;
template <>
inline constexpr int kEnumerators<Integrator> = 3;
template <>
inline constexpr int kEnumerators<ContactHome> = 4;
template <>
inline constexpr int kEnumerators<ContactHardness> = 5;
template <>
inline constexpr int kEnumerators<ImpactTracking> = 3;
template <>
inline constexpr int kEnumerators<BadField> = 7;

PLUMB_REAL_MEMBERS(Handle, index, generation)

PLUMB_MEMBERS(Thresholds, hit, bounce, sleep)

/// Excludes the number of threads: the program that continues with a world chooses its own.
template <>
struct Members<WorldDefinition> {
  [[maybe_unused]] static constexpr std::string_view
      kStruct = "WorldDefinition",
      kNames =
          "gravity, combine_friction, combine_restitution, sleeping, continuous, solver, integrator, "
          "iterations, direct_islands, quarantine, thresholds";
  static constexpr auto with(auto& it, const auto& act) {
    auto& [gravity, combine_friction, combine_restitution, sleeping, continuous, solver, integrator,
           iterations, direct_islands, quarantine, threads, thresholds] = it;
    return act(gravity, combine_friction, combine_restitution, sleeping, continuous, solver, integrator,
               iterations, direct_islands, quarantine, thresholds);
  }
};
PLUMB_MEMBERS(Filter, category, mask, group)

PLUMB_REAL_MEMBERS(BodyRecord, type, awake, may_sleep, lock_x, lock_y, lock_rotation, mass_given, quarantined,
                   awake_index, first_shape, first_contact, first_joint, constraints, uncommon, mass, inertia,
                   centre, half_width, sleep_time, angle)
PLUMB_REAL_MEMBERS(BodyExtras, name, gravity_scale, linear_damping, angular_damping, mass_centre, continuous)
PLUMB_REAL_MEMBERS(Load, force, torque)
PLUMB_MEMBERS(RestDisplacement, translation, rotation)
PLUMB_REAL_MEMBERS(SolverBody, velocity, angular_velocity, delta_position, delta_angle, inverse_mass,
                   inverse_inertia)

PLUMB_REAL_MEMBERS(ShapeForm, corner, count, chain, sensor, radius, extent)
PLUMB_REAL_MEMBERS(ShapeRecord, body, next, previous, proxy, chain, moved, hit_events, pre_solve, filter,
                   friction, restitution, rolling_resistance, surface_speed, density)
PLUMB_MEMBERS(ChainRecord, body, shapes)
PLUMB_MEMBERS(SensorRecord, shape, visitors)

PLUMB_MEMBERS(ContactRecord, shape_a, shape_b, body_a, body_b, previous, next, home, colour, touching,
              pre_solve, hit_events, index)
PLUMB_REAL_MEMBERS(ContactConstraint, body_a, body_b, normal, arm_a, arm_tangent_a, arm_b, arm_tangent_b,
                   separation, current_separation, normal_impulse, load_estimate, tangent_impulse, mass,
                   inverse_pp, inverse_pq, inverse_qq, k_pq, tangent_mass, friction, depenetration_speed,
                   surface_speed, hardness, count, touching, tracking, restitution, rolling_arm,
                   rolling_impulse, max_normal_impulse, step_impulse, approach, recycle_budget, contact,
                   features, locks)
PLUMB_MEMBERS(JointRecord, body_a, body_b, previous, next, slot, collide, active, break_force, break_torque,
              report_force, report_torque, user_data)

PLUMB_MEMBERS(TouchEvent, shape_a, shape_b)
PLUMB_MEMBERS(HitEvent, shape_a, shape_b, point, normal, speed, impulse)
PLUMB_MEMBERS(SensorEvent, sensor, visitor)
PLUMB_MEMBERS(JointEvent, joint)
PLUMB_MEMBERS(JointLoadEvent, joint, force, torque)
PLUMB_MEMBERS(QuarantineEvent, body, name, field, value, step)
PLUMB_MEMBERS(QuarantinedBody, body, type, why)
PLUMB_MEMBERS(Events, begin, end, hits, sensor_begin, sensor_end, broken, loaded, fell_asleep, woke,
              quarantined)

/// Returns all state that a world's future depends on, and the events of its last step, as a tuple of
/// references. It excludes code (the pre-solve hook, the user's filter and combine rules), the profile, the
/// threads, and scratch data. A new member of WorldData must be named here, and returned unless it is one of
/// these exceptions.
template <class World>
constexpr auto state_of(World& w) {
  auto& [settings, time, steps, last_h, impulse_h, bodies, body_extras, loads, body_data, motion, rotation,
         position, position_compensation, rest_displacements, extents, enlarged, awake, mass_changed_bodies,
         shapes, forms, tight_aabbs, corners, shape_data, chains, move_buffer, static_tree, dynamic_tree,
         contacts, pairs, nontouching_contacts, graph, sleeping_contacts, joints, joint_set, sensors,
         load_limited_joints, quarantine, events, pending, stepping, profiled, last_substeps, profile,
         scheduler, active_callbacks, abandoned, reports_hits, topology_changed, scratch, pre_solve, filter,
         friction_rule, restitution_rule, disabled_pairs, enabled_pairs] = w;
  return std::tie(settings, time, steps, last_h, impulse_h, bodies, body_extras, loads, body_data, motion,
                  rotation, position, position_compensation, rest_displacements, extents, enlarged, awake,
                  mass_changed_bodies, shapes, forms, tight_aabbs, corners, shape_data, chains, move_buffer,
                  static_tree, dynamic_tree, contacts, pairs, nontouching_contacts, graph, sleeping_contacts,
                  joints, joint_set, sensors, load_limited_joints, quarantine, events, pending, last_substeps,
                  reports_hits);
}

}  // namespace plumb
