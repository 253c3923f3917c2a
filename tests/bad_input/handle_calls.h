#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/force_laws.h"
#include "engine/world/queries.h"
#include "tests/bad_input/things.h"

/// Every call of a world that takes a handle.
namespace plumb::bad_input {

template <class Real, class Id>
using HandleCalls = std::vector<std::pair<std::string, std::function<void(Things<Real>&, Id)>>>;

template <class Real>
HandleCalls<Real, BodyId> body_calls() {
  using T = Things<Real>;
  return {
      {"destroy", [](T& t, BodyId id) { t.world.destroy(id); }},
      {"position", [](T& t, BodyId id) { t.world.position(id); }},
      {"centre", [](T& t, BodyId id) { t.world.centre(id); }},
      {"angle", [](T& t, BodyId id) { t.world.angle(id); }},
      {"velocity", [](T& t, BodyId id) { t.world.velocity(id); }},
      {"angular_velocity", [](T& t, BodyId id) { t.world.angular_velocity(id); }},
      {"velocity_at", [](T& t, BodyId id) { t.world.velocity_at(id, {}); }},
      {"world_point", [](T& t, BodyId id) { t.world.world_point(id, {}); }},
      {"local_point", [](T& t, BodyId id) { t.world.local_point(id, {}); }},
      {"state", [](T& t, BodyId id) { t.world.state(id); }},
      {"set_position", [](T& t, BodyId id) { t.world.set_position(id, {}, 0); }},
      {"set_velocity", [](T& t, BodyId id) { t.world.set_velocity(id, {}); }},
      {"set_angular_velocity", [](T& t, BodyId id) { t.world.set_angular_velocity(id, 0); }},
      {"move_towards", [](T& t, BodyId id) { t.world.move_towards(id, {}, 0, 1); }},
      {"apply_force", [](T& t, BodyId id) { t.world.apply_force(id, {}); }},
      {"apply_force", [](T& t, BodyId id) { t.world.apply_force(id, {}, {}); }},
      {"apply_torque", [](T& t, BodyId id) { t.world.apply_torque(id, 0); }},
      {"apply_impulse", [](T& t, BodyId id) { t.world.apply_impulse(id, {}); }},
      {"apply_impulse", [](T& t, BodyId id) { t.world.apply_impulse(id, {}, {}); }},
      {"apply_angular_impulse", [](T& t, BodyId id) { t.world.apply_angular_impulse(id, 0); }},
      {"type", [](T& t, BodyId id) { t.world.type(id); }},
      {"set_type", [](T& t, BodyId id) { t.world.set_type(id, BodyType::Static); }},
      {"mass", [](T& t, BodyId id) { t.world.mass(id); }},
      {"inertia", [](T& t, BodyId id) { t.world.inertia(id); }},
      {"set_mass", [](T& t, BodyId id) { t.world.set_mass(id, {}); }},
      {"use_densities", [](T& t, BodyId id) { t.world.use_densities(id); }},
      {"set_gravity_scale", [](T& t, BodyId id) { t.world.set_gravity_scale(id, 2); }},
      {"set_damping", [](T& t, BodyId id) { t.world.set_damping(id, 1, 1); }},
      {"set_locks", [](T& t, BodyId id) { t.world.set_locks(id, true, true, true); }},
      {"quarantined", [](T& t, BodyId id) { t.world.quarantined(id); }},
      {"release", [](T& t, BodyId id) { t.world.release(id); }},
      {"awake", [](T& t, BodyId id) { t.world.awake(id); }},
      {"set_awake", [](T& t, BodyId id) { t.world.set_awake(id, false); }},
      {"set_may_sleep", [](T& t, BodyId id) { t.world.set_may_sleep(id, false); }},
      {"may_sleep", [](T& t, BodyId id) { t.world.may_sleep(id); }},
      {"gravity_scale", [](T& t, BodyId id) { t.world.gravity_scale(id); }},
      {"linear_damping", [](T& t, BodyId id) { t.world.linear_damping(id); }},
      {"angular_damping", [](T& t, BodyId id) { t.world.angular_damping(id); }},
      {"locks", [](T& t, BodyId id) { t.world.locks(id); }},
      {"user_data", [](T& t, BodyId id) { t.world.user_data(id); }},
      {"set_user_data", [](T& t, BodyId id) { t.world.set_user_data(id, 5); }},
      {"set_continuous", [](T& t, BodyId id) { t.world.set_continuous(id, false); }},
      {"continuous", [](T& t, BodyId id) { t.world.continuous(id); }},
      {"set_name", [](T& t, BodyId id) { t.world.set_name(id, "other"); }},
      {"set_enabled", [](T& t, BodyId id) { t.world.set_enabled(id, false); }},
      {"enabled", [](T& t, BodyId id) { t.world.enabled(id); }},
      {"box", [](T& t, BodyId id) { t.world.box(id); }},
      {"contacts", [](T& t, BodyId id) { t.world.contacts(id, std::span<ContactReading>{}); }},
      {"name", [](T& t, BodyId id) { t.world.name(id); }},
      {"shapes", [](T& t, BodyId id) { t.world.shapes(id); }},
      {"joints", [](T& t, BodyId id) { t.world.joints(id); }},
      {"contacts", [](T& t, BodyId id) { t.world.contacts(id); }},
      {"create_shape", [](T& t, BodyId id) { t.world.create_shape(id, {}); }},
      {"create_chain",
       [](T& t, BodyId id) {
         t.world.create_chain(id, {.points = {{0, 0}, {1, 0}}});
       }},
      {"create_joint", [](T& t, BodyId id) { t.world.create_joint(id, t.box, {}); }},
      {"create_joint", [](T& t, BodyId id) { t.world.create_joint(t.box, id, {}); }},
      {"apply_attraction_to_body", [](T& t, BodyId id) { apply_attraction_to_body(t.world, id, {}, 0.1); }},
      {"apply_spring", [](T& t, BodyId id) { apply_spring(t.world, id, {}, t.box, {}, {}, 0.1); }},
      {"apply_spring", [](T& t, BodyId id) { apply_spring(t.world, t.box, {}, id, {}, {}, 0.1); }},
  };
}

template <class Real>
HandleCalls<Real, ShapeId> shape_calls() {
  using T = Things<Real>;
  return {
      {"destroy", [](T& t, ShapeId id) { t.world.destroy(id); }},
      {"body", [](T& t, ShapeId id) { t.world.body(id); }},
      {"user_data", [](T& t, ShapeId id) { t.world.user_data(id); }},
      {"set_user_data", [](T& t, ShapeId id) { t.world.set_user_data(id, 5); }},
      {"chain", [](T& t, ShapeId id) { t.world.chain(id); }},
      {"box", [](T& t, ShapeId id) { t.world.box(id); }},
      {"set_density", [](T& t, ShapeId id) { t.world.set_density(id, 2); }},
      {"set_geometry", [](T& t, ShapeId id) { t.world.set_geometry(id, Circle{0.5}); }},
      {"contact", [](T& t, ShapeId id) { t.world.contact(id, t.shape); }},
      {"contact", [](T& t, ShapeId id) { t.world.contact(t.shape, id); }},
      {"set_sensor", [](T& t, ShapeId id) { t.world.set_sensor(id, false); }},
      {"set_hit_events", [](T& t, ShapeId id) { t.world.set_hit_events(id, true); }},
      {"set_pre_solve", [](T& t, ShapeId id) { t.world.set_pre_solve(id, true); }},
      {"ray_cast",
       [](T& t, ShapeId id) {
         ray_cast(t.world, id, {}, {1, 0});
       }},
      {"contains", [](T& t, ShapeId id) { contains(t.world, id, {}); }},
      {"material", [](T& t, ShapeId id) { t.world.material(id); }},
      {"set_material", [](T& t, ShapeId id) { t.world.set_material(id, {}); }},
      {"filter", [](T& t, ShapeId id) { t.world.filter(id); }},
      {"definition", [](T& t, ShapeId id) { t.world.definition(id); }},
      {"density", [](T& t, ShapeId id) { t.world.density(id); }},
      {"sensor", [](T& t, ShapeId id) { t.world.sensor(id); }},
      {"hit_events", [](T& t, ShapeId id) { t.world.hit_events(id); }},
      {"pre_solve", [](T& t, ShapeId id) { t.world.pre_solve(id); }},
      {"set_filter", [](T& t, ShapeId id) { t.world.set_filter(id, {.category = 2}); }},
      {"overlapping", [](T& t, ShapeId id) { t.world.overlapping(id); }},
      {"distance", [](T& t, ShapeId id) { distance(t.world, id, t.shape); }},
      {"distance", [](T& t, ShapeId id) { distance(t.world, t.shape, id); }},
  };
}

template <class Real>
HandleCalls<Real, ChainId> chain_calls() {
  using T = Things<Real>;
  return {
      {"destroy", [](T& t, ChainId id) { t.world.destroy(id); }},
      {"segments", [](T& t, ChainId id) { t.world.segments(id); }},
      {"body", [](T& t, ChainId id) { t.world.body(id); }},
      {"definition", [](T& t, ChainId id) { t.world.definition(id); }},
  };
}

template <class Real>
HandleCalls<Real, JointId> joint_calls() {
  using T = Things<Real>;
  return {
      {"destroy", [](T& t, JointId id) { t.world.destroy(id); }},
      {"kind", [](T& t, JointId id) { t.world.kind(id); }},
      {"change", [](T& t, JointId id) { t.world.change(id, RevoluteDefinition{}); }},
      {"read", [](T& t, JointId id) { t.world.read(id); }},
      {"stiffness", [](T& t, JointId id) { t.world.stiffness(id); }},
      {"definition", [](T& t, JointId id) { t.world.definition(id); }},
      {"user_data", [](T& t, JointId id) { t.world.user_data(id); }},
      {"set_user_data", [](T& t, JointId id) { t.world.set_user_data(id, 5); }},
      {"set_load_events", [](T& t, JointId id) { t.world.set_load_events(id, 1, 1); }},
      {"bodies", [](T& t, JointId id) { t.world.bodies(id); }},
  };
}

}  // namespace plumb::bad_input
