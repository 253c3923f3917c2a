#pragma once

#include <cstdint>
#include <tuple>

#include "engine/world/world.h"

namespace plumb {

/// Lists every call that changes a world, once: X(name in recordings, member, result, arguments...).
/// Recordings number calls in this order: append new ones at the end.
#define PLUMB_WORLD_CALLS(X)                                                                  \
  X(Step, step, void, double, int)                                                            \
  X(SetGravity, set_gravity, void, Vec2d)                                                     \
  X(SetSleeping, set_sleeping, void, bool)                                                    \
  X(SetContinuous, set_continuous, void, bool)                                                \
  X(CreateBody, create_body, BodyId, const BodyDefinition&, std::span<const ShapeDefinition>) \
  X(CreateBodyWithShape, create_body, BodyId, const BodyDefinition&, const ShapeDefinition&)  \
  X(DestroyBody, destroy, void, BodyId)                                                       \
  X(SetPosition, set_position, void, BodyId, Vec2d, double)                                   \
  X(SetVelocity, set_velocity, void, BodyId, Vec2d)                                           \
  X(SetAngularVelocity, set_angular_velocity, void, BodyId, double)                           \
  X(MoveTowards, move_towards, void, BodyId, Vec2d, double, double)                           \
  X(ApplyForce, apply_force, void, BodyId, Vec2d)                                             \
  X(ApplyForceAt, apply_force, void, BodyId, Vec2d, Vec2d)                                    \
  X(ApplyTorque, apply_torque, void, BodyId, double)                                          \
  X(ApplyImpulse, apply_impulse, void, BodyId, Vec2d)                                         \
  X(ApplyImpulseAt, apply_impulse, void, BodyId, Vec2d, Vec2d)                                \
  X(ApplyAngularImpulse, apply_angular_impulse, void, BodyId, double)                         \
  X(SetType, set_type, void, BodyId, BodyType)                                                \
  X(SetMass, set_mass, void, BodyId, const MassProperties&)                                   \
  X(UseDensities, use_densities, void, BodyId)                                                \
  X(SetGravityScale, set_gravity_scale, void, BodyId, double)                                 \
  X(SetDamping, set_damping, void, BodyId, double, double)                                    \
  X(SetLocks, set_locks, void, BodyId, bool, bool, bool)                                      \
  X(SetAwake, set_awake, void, BodyId, bool)                                                  \
  X(SetMaySleep, set_may_sleep, void, BodyId, bool)                                           \
  X(CreateShape, create_shape, ShapeId, BodyId, const ShapeDefinition&)                       \
  X(DestroyShape, destroy, void, ShapeId)                                                     \
  X(SetMaterial, set_material, void, ShapeId, const Material&)                                \
  X(SetFilter, set_filter, void, ShapeId, const Filter&)                                      \
  X(CreateChain, create_chain, ChainId, BodyId, const ChainDefinition&)                       \
  X(DestroyChain, destroy, void, ChainId)                                                     \
  X(CreateJoint, create_joint, JointId, BodyId, BodyId, const JointDefinition&)               \
  X(DestroyJoint, destroy, void, JointId)                                                     \
  X(Change, change, void, JointId, const JointKind&)                                          \
  X(SetSolver, set_solver, void, Solver)                                                      \
  X(SetIterations, set_iterations, void, int)                                                 \
  X(SetDirectIslands, set_direct_islands, void, bool)                                         \
  X(SetQuarantine, set_quarantine, void, bool)                                                \
  X(Release, release, void, BodyId)                                                           \
  X(SetBodyData, set_user_data, void, BodyId, std::uint64_t)                                  \
  X(SetShapeData, set_user_data, void, ShapeId, std::uint64_t)                                \
  X(SetJointData, set_user_data, void, JointId, std::uint64_t)                                \
  X(SetName, set_name, void, BodyId, const std::string&)                                      \
  X(SetEnabled, set_enabled, void, BodyId, bool)                                              \
  X(SetDensity, set_density, void, ShapeId, double)                                           \
  X(SetSensor, set_sensor, void, ShapeId, bool)                                               \
  X(SetHitEvents, set_hit_events, void, ShapeId, bool)                                        \
  X(SetShapePreSolve, set_pre_solve, void, ShapeId, bool)                                     \
  X(SetBodyContinuous, set_continuous, void, BodyId, bool)                                    \
  X(SetLoadEvents, set_load_events, void, JointId, double, double)                            \
  X(SetThresholds, set_thresholds, void, const Thresholds&)                                   \
  X(SetGeometry, set_geometry, void, ShapeId, const ShapeGeometry&, Vec2d, double)

enum class WorldCall : std::uint8_t {
#define PLUMB_NAME(id, name, result, ...) id,
  PLUMB_WORLD_CALLS(PLUMB_NAME)
#undef PLUMB_NAME
};

/// Names of the members, by WorldCall.
inline constexpr const char* kWorldCallNames[] = {
#define PLUMB_NAME(id, name, result, ...) #name,
    PLUMB_WORLD_CALLS(PLUMB_NAME)
#undef PLUMB_NAME
};

inline constexpr int kWorldCalls = static_cast<int>(std::size(kWorldCallNames));

/// Returns the member pointers, by WorldCall.
template <class Real>
constexpr auto world_calls() {
  using Type = BasicWorld<Real>;
  return std::tuple_cat(
#define PLUMB_MEMBER(id, name, result, ...) \
  std::tuple{static_cast<result (Type::*)(__VA_ARGS__)>(&Type::name)},
      PLUMB_WORLD_CALLS(PLUMB_MEMBER)
#undef PLUMB_MEMBER
          std::tuple<>{});
}

}  // namespace plumb
