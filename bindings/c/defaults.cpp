#include "bindings/c/handle.h"
#include "engine/joints/definitions.h"
#include "engine/world/mover.h"

plumb_world_definition plumb::c::out(const plumb::WorldDefinition& d, plumb_precision precision) {
  plumb_world_definition result{};
  result.precision = precision;
  result.gravity = out(d.gravity);
  result.combine_friction = static_cast<plumb_combine>(d.combine_friction);
  result.combine_restitution = static_cast<plumb_combine>(d.combine_restitution);
  result.sleeping = d.sleeping;
  result.continuous = d.continuous;
  result.solver = static_cast<plumb_solver>(d.solver);
  result.integrator = static_cast<plumb_integrator>(d.integrator);
  result.iterations = d.iterations;
  result.direct_islands = d.direct_islands;
  result.quarantine = d.quarantine;
  result.thresholds = {d.thresholds.hit, d.thresholds.bounce, d.thresholds.sleep};
  result.threads = d.threads;
  return result;
}
plumb_world_definition plumb_default_world(void) {
  return plumb::c::out(plumb::WorldDefinition{}, PLUMB_FLOAT);
}

plumb_body_definition plumb_default_body(void) {
  const plumb::BodyDefinition d;
  const plumb::MassProperties mass;
  plumb_body_definition result{};
  result.type = static_cast<plumb_body_type>(d.type);
  result.mass = {mass.mass, {mass.centre.x, mass.centre.y}, mass.inertia};
  result.gravity_scale = d.gravity_scale;
  result.may_sleep = d.may_sleep;
  result.awake = d.awake;
  result.continuous = d.continuous;
  return result;
}

plumb_shape_definition plumb_default_shape(void) {
  const plumb::ShapeDefinition d;
  plumb_shape_definition result{};
  result.geometry = plumb_circle(0.5);
  result.density = d.density;
  result.material = plumb::c::out(d.material);
  result.filter = plumb::c::out(d.filter);
  return result;
}

plumb_chain_definition plumb_default_chain(void) {
  const plumb::ChainDefinition d;
  plumb_chain_definition result{};
  result.material = plumb::c::out(d.material);
  result.filter = plumb::c::out(d.filter);
  return result;
}

plumb_joint_definition plumb_default_joint(plumb_joint_kind kind) {
  plumb_joint_definition result{};
  result.kind = kind;
  // For an unknown kind it keeps the error, and create_joint refuses the definition.
  plumb::c::checked([&] { plumb::c::in<int>(kind, 11, "joint", "kind"); });
  result.axis = {1, 0};
  result.length = 1;
  result.ratio = 1;
  if (kind == PLUMB_WHEEL) result.axis = {0, 1};
  if (kind == PLUMB_GEAR) result.ratio = plumb::GearDefinition{}.ratio;
  if (kind == PLUMB_PULLEY) result.length = -1;
  if (kind == PLUMB_RATCHET) result.tooth = plumb::RatchetDefinition{}.tooth;
  const auto spring = [&](const plumb::Spring& given) {
    result.spring = {true, given.hertz, given.damping_ratio};
  };
  if (kind == PLUMB_MOTOR) spring(plumb::MotorDefinition{}.spring);
  if (kind == PLUMB_MOUSE) spring(plumb::MouseDefinition{}.spring);
  return result;
}

plumb_geometry plumb_circle(double radius) {
  plumb_geometry result{};
  result.kind = PLUMB_CIRCLE;
  result.radius = radius;
  return result;
}
plumb_geometry plumb_box(double width, double height) {
  plumb_geometry result{};
  result.kind = PLUMB_BOX;
  result.width = width, result.height = height;
  return result;
}
plumb_geometry plumb_capsule(plumb_vec2 start, plumb_vec2 end, double radius) {
  plumb_geometry result{};
  result.kind = PLUMB_CAPSULE;
  result.start = start, result.end = end, result.radius = radius;
  return result;
}
plumb_geometry plumb_polygon(const plumb_vec2* points, size_t count, double radius) {
  plumb_geometry result{};
  result.kind = PLUMB_POLYGON;
  result.points = points, result.point_count = count, result.radius = radius;
  return result;
}
plumb_geometry plumb_segment(plumb_vec2 start, plumb_vec2 end) {
  plumb_geometry result{};
  result.kind = PLUMB_SEGMENT;
  result.start = start, result.end = end;
  return result;
}

plumb_query_filter plumb_default_query_filter(void) {
  const plumb::QueryFilter d;
  plumb_query_filter result{};
  result.category = d.category, result.mask = d.mask;
  result.ignore = plumb::c::kNoBody;
  return result;
}

plumb_mover_options plumb_default_mover(void) {
  const plumb::MoverOptions d;
  plumb_mover_options result{};
  result.up = plumb::c::out(d.up);
  result.max_slope = d.max_slope, result.step_height = d.step_height, result.skin = d.skin;
  result.mass = d.mass, result.push_force = d.push_force;
  result.filter = plumb_default_query_filter();
  return result;
}
