#include "bindings/c/handle.h"
#include "bindings/javascript/buffer.h"

using namespace plumb::c;
using namespace plumb::javascript;

extern "C" {

/// Reads the definition from the numbers, and the name from the bytes.
PLUMB_EXPORT("body_create") double* js_body_create(plumb_world* w) {
  // Kept from call to call: nothing would free them when the world refuses one of them.
  static plumb::BodyDefinition d;
  static std::vector<plumb::ShapeDefinition> shapes;
  static ShapeInput input;
  Reader r;
  d.type = static_cast<plumb::BodyType>(r.integer());
  d.position = in(r.point()), d.angle = r.number();
  d.velocity = in(r.point()), d.angular_velocity = r.number();
  const bool mass_given = r.flag();
  const double mass = r.number();
  const plumb_vec2 centre = r.point();
  const double inertia = r.number();
  d.mass.reset();
  if (mass_given) d.mass = {mass, in(centre), inertia};
  d.gravity_scale = r.number(), d.linear_damping = r.number(), d.angular_damping = r.number();
  d.lock_x = r.flag(), d.lock_y = r.flag(), d.lock_rotation = r.flag();
  d.may_sleep = r.flag(), d.awake = r.flag(), d.continuous = r.flag();
  d.user_data = r.wide();
  bytes.push_back(0);
  d.name = reinterpret_cast<const char*>(bytes.data());
  shapes.clear();
  const std::uint32_t count = r.bits();
  for (std::uint32_t i = 0; i < count; ++i) {
    read(r, input);
    shapes.push_back(in(input.definition));
  }
  const plumb_body made = change(w, [&](auto& world) { return out(world.create_body(d, shapes)); });
  return Writer().id(made).done();
}

#define PLUMB_BODY_CALL(name, call, ...)                                                              \
  PLUMB_EXPORT("body_" #name)                                                                         \
  void js_body_##name(plumb_world* w, std::uint32_t index, std::uint32_t generation, ##__VA_ARGS__) { \
    const plumb_body body{index, generation};                                                         \
    call;                                                                                             \
  }
#define PLUMB_BODY_READ(name, Result, value)                                             \
  PLUMB_EXPORT("body_" #name)                                                            \
  Result js_body_##name(plumb_world* w, std::uint32_t index, std::uint32_t generation) { \
    const plumb_body body{index, generation};                                            \
    return value;                                                                        \
  }
PLUMB_BODY_CALL(destroy, plumb_body_destroy(w, body))
PLUMB_BODY_CALL(set_pose, plumb_body_set_pose(w, body, {{x, y}, angle}), double x, double y, double angle)
PLUMB_BODY_CALL(set_velocity, plumb_body_set_velocity(w, body, {x, y}), double x, double y)
PLUMB_BODY_CALL(set_angular_velocity, plumb_body_set_angular_velocity(w, body, value), double value)
PLUMB_BODY_CALL(move_towards, plumb_body_move_towards(w, body, {{x, y}, angle}, dt), double x, double y,
                double angle, double dt)
PLUMB_BODY_CALL(apply_force, plumb_body_apply_force(w, body, {x, y}), double x, double y)
PLUMB_BODY_CALL(apply_force_at, plumb_body_apply_force_at(w, body, {x, y}, {px, py}), double x, double y,
                double px, double py)
PLUMB_BODY_CALL(apply_torque, plumb_body_apply_torque(w, body, value), double value)
PLUMB_BODY_CALL(apply_impulse, plumb_body_apply_impulse(w, body, {x, y}), double x, double y)
PLUMB_BODY_CALL(apply_impulse_at, plumb_body_apply_impulse_at(w, body, {x, y}, {px, py}), double x, double y,
                double px, double py)
PLUMB_BODY_CALL(apply_angular_impulse, plumb_body_apply_angular_impulse(w, body, value), double value)
PLUMB_BODY_CALL(set_type, plumb_body_set_type(w, body, static_cast<plumb_body_type>(type)), int type)
PLUMB_BODY_CALL(set_mass, plumb_body_set_mass(w, body, {mass, {x, y}, inertia}), double mass, double x,
                double y, double inertia)
PLUMB_BODY_CALL(use_densities, plumb_body_use_densities(w, body))
PLUMB_BODY_CALL(set_gravity_scale, plumb_body_set_gravity_scale(w, body, value), double value)
PLUMB_BODY_CALL(set_damping, plumb_body_set_damping(w, body, linear, angular), double linear, double angular)
PLUMB_BODY_CALL(set_locks, plumb_body_set_locks(w, body, x != 0, y != 0, rotation != 0), int x, int y,
                int rotation)
PLUMB_BODY_CALL(set_awake, plumb_body_set_awake(w, body, on != 0), int on)
PLUMB_BODY_CALL(set_may_sleep, plumb_body_set_may_sleep(w, body, on != 0), int on)
PLUMB_BODY_CALL(set_continuous, plumb_body_set_continuous(w, body, on != 0), int on)
PLUMB_BODY_CALL(set_enabled, plumb_body_set_enabled(w, body, on != 0), int on)
PLUMB_BODY_CALL(set_user_data, plumb_body_set_user_data(w, body, data), std::uint64_t data)
/// Takes the name from the bytes.
PLUMB_BODY_CALL(set_name, (bytes.push_back(0),
                           plumb_body_set_name(w, body, reinterpret_cast<const char*>(bytes.data()))))
PLUMB_BODY_CALL(release, plumb_body_release(w, body))
PLUMB_BODY_READ(continuous, int, plumb_body_continuous(w, body))
PLUMB_BODY_READ(valid, int, plumb_body_valid(w, body))
PLUMB_BODY_READ(position, double*, Writer().add(plumb_body_position(w, body)).done())
PLUMB_BODY_READ(centre, double*, Writer().add(plumb_body_centre(w, body)).done())
PLUMB_BODY_READ(angle, double, plumb_body_angle(w, body))
PLUMB_BODY_READ(velocity, double*, Writer().add(plumb_body_velocity(w, body)).done())
PLUMB_BODY_READ(angular_velocity, double, plumb_body_angular_velocity(w, body))
PLUMB_BODY_READ(type, int, plumb_body_get_type(w, body))
PLUMB_BODY_READ(mass, double, plumb_body_mass(w, body))
PLUMB_BODY_READ(inertia, double, plumb_body_inertia(w, body))
PLUMB_BODY_READ(gravity_scale, double, plumb_body_gravity_scale(w, body))
PLUMB_BODY_READ(linear_damping, double, plumb_body_linear_damping(w, body))
PLUMB_BODY_READ(angular_damping, double, plumb_body_angular_damping(w, body))
PLUMB_BODY_READ(may_sleep, int, plumb_body_may_sleep(w, body))
PLUMB_BODY_READ(locks, int,
                plumb_body_locks(w, body).x + 2 * plumb_body_locks(w, body).y +
                    4 * plumb_body_locks(w, body).rotation)
PLUMB_BODY_READ(enabled, int, plumb_body_enabled(w, body))
PLUMB_BODY_READ(box, double*,
                Writer().add(plumb_body_box(w, body).lower).add(plumb_body_box(w, body).upper).done())
PLUMB_BODY_READ(awake, int, plumb_body_awake(w, body))
PLUMB_BODY_READ(user_data, std::uint64_t, plumb_body_user_data(w, body))
PLUMB_BODY_READ(name, const char*, plumb_body_name(w, body))
PLUMB_BODY_READ(quarantined, int, plumb_body_quarantined(w, body))
/// Returns the shapes of a body.
PLUMB_EXPORT("body_shapes")
double* js_body_shapes(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  const plumb_body body{index, generation};
  std::vector<plumb_shape> all(plumb_body_shapes(w, body, nullptr, 0));
  plumb_body_shapes(w, body, all.data(), all.size());
  return Writer().ids(all).done();
}
PLUMB_EXPORT("body_joints")
double* js_body_joints(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  const plumb_body body{index, generation};
  return Writer()
      .ids(all_of<plumb_joint>([&](auto* to, std::size_t n) { return plumb_body_joints(w, body, to, n); }))
      .done();
}
#define PLUMB_BODY_POINT(name)                                                                    \
  PLUMB_EXPORT("body_" #name)                                                                     \
  double* js_body_##name(plumb_world* w, std::uint32_t index, std::uint32_t generation, double x, \
                         double y) {                                                              \
    return Writer().add(plumb_body_##name(w, {index, generation}, {x, y})).done();                \
  }
PLUMB_BODY_POINT(velocity_at)
PLUMB_BODY_POINT(world_point)
PLUMB_BODY_POINT(local_point)
}
