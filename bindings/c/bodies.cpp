#include "bindings/c/handle.h"

using namespace plumb::c;

namespace {

plumb::BodyDefinition definition_of(const plumb_body_definition& d) {
  plumb::BodyDefinition result;
  if (d.name != nullptr) result.name = d.name;
  result.type = in<plumb::BodyType>(d.type, 3, "body", "type");
  result.position = in(d.position), result.angle = d.angle;
  result.velocity = in(d.velocity), result.angular_velocity = d.angular_velocity;
  if (d.mass_given) result.mass = {d.mass.mass, in(d.mass.centre), d.mass.inertia};
  result.gravity_scale = d.gravity_scale;
  result.linear_damping = d.linear_damping, result.angular_damping = d.angular_damping;
  result.lock_x = d.lock_x, result.lock_y = d.lock_y, result.lock_rotation = d.lock_rotation;
  result.may_sleep = d.may_sleep, result.awake = d.awake;
  result.user_data = d.user_data;
  result.continuous = d.continuous;
  return result;
}

}  // namespace

plumb_body plumb_body_create(plumb_world* world, const plumb_body_definition* definition,
                             const plumb_shape_definition* shapes, size_t shape_count) {
  return checked_or(kNoBody, [&] {
    const plumb::BodyDefinition body = definition_of(require(definition, "body definition"));
    std::vector<plumb::ShapeDefinition> all;
    require_countable("body", "shape_count", shape_count, kMostItems);
    if (shape_count > 0) require(shapes, "shapes");
    for (size_t i = 0; i < shape_count; ++i) all.push_back(in(shapes[i]));
    return change(world, [&](auto& w) { return out(w.create_body(body, all)); });
  });
}
plumb_status plumb_body_destroy(plumb_world* world, plumb_body body) {
  return change_checked(world, [&](auto& w) { w.destroy(in(body)); });
}
bool plumb_body_valid(const plumb_world* world, plumb_body body) {
  return read_or(false, world, [&](const auto& w) { return w.valid(in(body)); });
}

plumb_body_state plumb_body_get_state(const plumb_world* world, plumb_body body) {
  return read_or(plumb_body_state{}, world, [&](const auto& w) { return out(w.state(in(body))); });
}
plumb_pose plumb_body_pose(const plumb_world* world, plumb_body body) {
  return read_or(plumb_pose{}, world, [&](const auto& w) {
    return plumb_pose{out(w.position(in(body))), w.angle(in(body))};
  });
}
plumb_vec2 plumb_body_position(const plumb_world* world, plumb_body body) {
  return read_or(plumb_vec2{}, world, [&](const auto& w) { return out(w.position(in(body))); });
}
plumb_vec2 plumb_body_centre(const plumb_world* world, plumb_body body) {
  return read_or(plumb_vec2{}, world, [&](const auto& w) { return out(w.centre(in(body))); });
}
double plumb_body_angle(const plumb_world* world, plumb_body body) {
  return read_or(0.0, world, [&](const auto& w) { return w.angle(in(body)); });
}
plumb_vec2 plumb_body_velocity(const plumb_world* world, plumb_body body) {
  return read_or(plumb_vec2{}, world, [&](const auto& w) { return out(w.velocity(in(body))); });
}
double plumb_body_angular_velocity(const plumb_world* world, plumb_body body) {
  return read_or(0.0, world, [&](const auto& w) { return w.angular_velocity(in(body)); });
}
plumb_vec2 plumb_body_velocity_at(const plumb_world* world, plumb_body body, plumb_vec2 point) {
  return read_or(plumb_vec2{}, world, [&](const auto& w) { return out(w.velocity_at(in(body), in(point))); });
}
plumb_vec2 plumb_body_world_point(const plumb_world* world, plumb_body body, plumb_vec2 local) {
  return read_or(plumb_vec2{}, world, [&](const auto& w) { return out(w.world_point(in(body), in(local))); });
}
plumb_vec2 plumb_body_local_point(const plumb_world* world, plumb_body body, plumb_vec2 point) {
  return read_or(plumb_vec2{}, world, [&](const auto& w) { return out(w.local_point(in(body), in(point))); });
}

plumb_status plumb_body_set_pose(plumb_world* world, plumb_body body, plumb_pose pose) {
  return change_checked(world, [&](auto& w) { w.set_position(in(body), in(pose.position), pose.angle); });
}
plumb_status plumb_body_set_velocity(plumb_world* world, plumb_body body, plumb_vec2 velocity) {
  return change_checked(world, [&](auto& w) { w.set_velocity(in(body), in(velocity)); });
}
plumb_status plumb_body_set_angular_velocity(plumb_world* world, plumb_body body, double velocity) {
  return change_checked(world, [&](auto& w) { w.set_angular_velocity(in(body), velocity); });
}
plumb_status plumb_body_move_towards(plumb_world* world, plumb_body body, plumb_pose pose, double dt) {
  return change_checked(world, [&](auto& w) { w.move_towards(in(body), in(pose.position), pose.angle, dt); });
}

plumb_status plumb_body_apply_force(plumb_world* world, plumb_body body, plumb_vec2 force) {
  return change_checked(world, [&](auto& w) { w.apply_force(in(body), in(force)); });
}
plumb_status plumb_body_apply_force_at(plumb_world* world, plumb_body body, plumb_vec2 force,
                                       plumb_vec2 point) {
  return change_checked(world, [&](auto& w) { w.apply_force(in(body), in(force), in(point)); });
}
plumb_status plumb_body_apply_torque(plumb_world* world, plumb_body body, double torque) {
  return change_checked(world, [&](auto& w) { w.apply_torque(in(body), torque); });
}
plumb_status plumb_body_apply_impulse(plumb_world* world, plumb_body body, plumb_vec2 impulse) {
  return change_checked(world, [&](auto& w) { w.apply_impulse(in(body), in(impulse)); });
}
plumb_status plumb_body_apply_impulse_at(plumb_world* world, plumb_body body, plumb_vec2 impulse,
                                         plumb_vec2 point) {
  return change_checked(world, [&](auto& w) { w.apply_impulse(in(body), in(impulse), in(point)); });
}
plumb_status plumb_body_apply_angular_impulse(plumb_world* world, plumb_body body, double impulse) {
  return change_checked(world, [&](auto& w) { w.apply_angular_impulse(in(body), impulse); });
}

plumb_body_type plumb_body_get_type(const plumb_world* world, plumb_body body) {
  return read_or(PLUMB_STATIC, world,
                 [&](const auto& w) { return static_cast<plumb_body_type>(w.type(in(body))); });
}
plumb_status plumb_body_set_type(plumb_world* world, plumb_body body, plumb_body_type type) {
  return change_checked(world,
                        [&](auto& w) { w.set_type(in(body), in<plumb::BodyType>(type, 3, "body", "type")); });
}
double plumb_body_mass(const plumb_world* world, plumb_body body) {
  return read_or(0.0, world, [&](const auto& w) { return w.mass(in(body)); });
}
double plumb_body_inertia(const plumb_world* world, plumb_body body) {
  return read_or(0.0, world, [&](const auto& w) { return w.inertia(in(body)); });
}
plumb_status plumb_body_set_mass(plumb_world* world, plumb_body body, plumb_mass mass) {
  return change_checked(world, [&](auto& w) {
    w.set_mass(in(body), {mass.mass, in(mass.centre), mass.inertia});
  });
}
plumb_status plumb_body_use_densities(plumb_world* world, plumb_body body) {
  return change_checked(world, [&](auto& w) { w.use_densities(in(body)); });
}
plumb_status plumb_body_set_gravity_scale(plumb_world* world, plumb_body body, double scale) {
  return change_checked(world, [&](auto& w) { w.set_gravity_scale(in(body), scale); });
}
double plumb_body_gravity_scale(const plumb_world* world, plumb_body body) {
  return read_or(0.0, world, [&](const auto& w) { return w.gravity_scale(in(body)); });
}
plumb_status plumb_body_set_damping(plumb_world* world, plumb_body body, double linear, double angular) {
  return change_checked(world, [&](auto& w) { w.set_damping(in(body), linear, angular); });
}
double plumb_body_linear_damping(const plumb_world* world, plumb_body body) {
  return read_or(0.0, world, [&](const auto& w) { return w.linear_damping(in(body)); });
}
double plumb_body_angular_damping(const plumb_world* world, plumb_body body) {
  return read_or(0.0, world, [&](const auto& w) { return w.angular_damping(in(body)); });
}
plumb_status plumb_body_set_locks(plumb_world* world, plumb_body body, bool x, bool y, bool rotation) {
  return change_checked(world, [&](auto& w) { w.set_locks(in(body), x, y, rotation); });
}
plumb_locks plumb_body_locks(const plumb_world* world, plumb_body body) {
  return read_or(plumb_locks{}, world, [&](const auto& w) {
    const plumb::BodyLocks locks = w.locks(in(body));
    return plumb_locks{locks.x, locks.y, locks.rotation};
  });
}
plumb_status plumb_body_set_continuous(plumb_world* world, plumb_body body, bool on) {
  return change_checked(world, [&](auto& w) { w.set_continuous(in(body), on); });
}
bool plumb_body_continuous(const plumb_world* world, plumb_body body) {
  return read_or(false, world, [&](const auto& w) { return w.continuous(in(body)); });
}
bool plumb_body_awake(const plumb_world* world, plumb_body body) {
  return read_or(false, world, [&](const auto& w) { return w.awake(in(body)); });
}
plumb_status plumb_body_set_awake(plumb_world* world, plumb_body body, bool awake) {
  return change_checked(world, [&](auto& w) { w.set_awake(in(body), awake); });
}
plumb_status plumb_body_set_may_sleep(plumb_world* world, plumb_body body, bool may_sleep) {
  return change_checked(world, [&](auto& w) { w.set_may_sleep(in(body), may_sleep); });
}
bool plumb_body_may_sleep(const plumb_world* world, plumb_body body) {
  return read_or(false, world, [&](const auto& w) { return w.may_sleep(in(body)); });
}
uint64_t plumb_body_user_data(const plumb_world* world, plumb_body body) {
  return read_or<uint64_t>(0, world, [&](const auto& w) { return w.user_data(in(body)); });
}
const char* plumb_body_name(const plumb_world* world, plumb_body body) {
  return read_or<const char*>("", world, [&](const auto& w) { return w.name(in(body)).c_str(); });
}
plumb_status plumb_body_set_user_data(plumb_world* world, plumb_body body, uint64_t data) {
  return change_checked(world, [&](auto& w) { w.set_user_data(in(body), data); });
}
plumb_status plumb_body_set_name(plumb_world* world, plumb_body body, const char* name) {
  return change_checked(world, [&](auto& w) { w.set_name(in(body), name != nullptr ? name : ""); });
}
plumb_status plumb_body_set_enabled(plumb_world* world, plumb_body body, bool enabled) {
  return change_checked(world, [&](auto& w) { w.set_enabled(in(body), enabled); });
}
bool plumb_body_enabled(const plumb_world* world, plumb_body body) {
  return read_or(false, world, [&](const auto& w) { return w.enabled(in(body)); });
}
plumb_box_bounds plumb_body_box(const plumb_world* world, plumb_body body) {
  return read_or(plumb_box_bounds{}, world, [&](const auto& w) { return out(w.box(in(body))); });
}
bool plumb_body_quarantined(const plumb_world* world, plumb_body body) {
  return read_or(false, world, [&](const auto& w) { return w.quarantined(in(body)); });
}
plumb_status plumb_body_release(plumb_world* world, plumb_body body) {
  return change_checked(world, [&](auto& w) { w.release(in(body)); });
}

size_t plumb_body_shapes(const plumb_world* world, plumb_body body, plumb_shape* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) { return fill(w.shapes(in(body)), to, capacity); });
}
size_t plumb_body_joints(const plumb_world* world, plumb_body body, plumb_joint* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) { return fill(w.joints(in(body)), to, capacity); });
}
