#include "bindings/javascript/buffer.h"

using namespace plumb::javascript;

namespace {

plumb_spring spring(Reader& r) {
  const bool on = r.flag();
  const double hertz = r.number();
  return {on, hertz, r.number()};
}

plumb_joint_definition joint(Reader& r) {
  plumb_joint_definition d = plumb_default_joint(static_cast<plumb_joint_kind>(r.integer()));
  d.collide = r.flag(), d.break_force = r.number(), d.break_torque = r.number();
  d.user_data = r.wide();
  d.report_force = r.number(), d.report_torque = r.number();
  d.anchor_a = r.point(), d.anchor_b = r.point(), d.axis = r.point();
  d.reference_angle = r.number();
  d.spring = spring(r), d.linear_spring = spring(r), d.angular_spring = spring(r);
  d.limits.on = r.flag(), d.limits.lower = r.number(), d.limits.upper = r.number();
  d.motor.on = r.flag(), d.motor.speed = r.number(), d.motor.max_force = r.number();
  d.length = r.number(), d.target_angle = r.number(), d.target_translation = r.number();
  d.target_position = r.point();
  d.max_force = r.number(), d.max_torque = r.number(), d.ratio = r.number();
  d.phase = r.number(), d.tooth = r.number();
  d.ground_a = r.point(), d.ground_b = r.point();
  return d;
}

/// Writes what `joint` reads.
void write(Writer& w, const plumb_joint_definition& d) {
  const auto spring_of = [&](const plumb_spring& s) { w.add(s.on).add(s.hertz).add(s.damping_ratio); };
  w.add(d.kind).add(d.collide).add(d.break_force).add(d.break_torque).wide(d.user_data);
  w.add(d.report_force).add(d.report_torque).add(d.anchor_a).add(d.anchor_b).add(d.axis);
  w.add(d.reference_angle);
  spring_of(d.spring), spring_of(d.linear_spring), spring_of(d.angular_spring);
  w.add(d.limits.on).add(d.limits.lower).add(d.limits.upper);
  w.add(d.motor.on).add(d.motor.speed).add(d.motor.max_force);
  w.add(d.length).add(d.target_angle).add(d.target_translation).add(d.target_position);
  w.add(d.max_force).add(d.max_torque).add(d.ratio).add(d.phase).add(d.tooth);
  w.add(d.ground_a).add(d.ground_b);
}

}  // namespace

extern "C" {

PLUMB_EXPORT("joint_definition") double* js_joint_definition(PLUMB_HANDLE) {
  const plumb_joint_definition d = plumb_joint_get_definition(w, {index, generation});
  Writer out;
  write(out, d);
  return out.done();
}
PLUMB_EXPORT("joint_bodies") double* js_joint_bodies(PLUMB_HANDLE) {
  plumb_body a{}, b{};
  plumb_joint_bodies(w, {index, generation}, &a, &b);
  return Writer().id(a).id(b).done();
}
PLUMB_EXPORT("joint_user_data") std::uint64_t js_joint_user_data(PLUMB_HANDLE) {
  return plumb_joint_user_data(w, {index, generation});
}
PLUMB_EXPORT("joint_set_user_data") void js_joint_set_user_data(PLUMB_HANDLE, std::uint64_t data) {
  plumb_joint_set_user_data(w, {index, generation}, data);
}

PLUMB_EXPORT("joint_create")
double* js_joint_create(plumb_world* w, std::uint32_t a, std::uint32_t a_generation, std::uint32_t b,
                        std::uint32_t b_generation) {
  Reader r;
  const plumb_joint_definition d = joint(r);
  return Writer().id(plumb_joint_create(w, {a, a_generation}, {b, b_generation}, &d)).done();
}
PLUMB_EXPORT("joint_destroy") void js_joint_destroy(PLUMB_HANDLE) {
  plumb_joint_destroy(w, {index, generation});
}
PLUMB_EXPORT("joint_valid") int js_joint_valid(PLUMB_HANDLE) {
  return plumb_joint_valid(w, {index, generation});
}
PLUMB_EXPORT("joint_change") void js_joint_change(PLUMB_HANDLE) {
  Reader r;
  const plumb_joint_definition d = joint(r);
  plumb_joint_change(w, {index, generation}, &d);
}
PLUMB_EXPORT("joint_set_load_events")
void js_joint_set_load_events(PLUMB_HANDLE, double force, double torque) {
  plumb_joint_set_load_events(w, {index, generation}, force, torque);
}
PLUMB_EXPORT("joint_stiffness") double* js_joint_stiffness(PLUMB_HANDLE) {
  const plumb_joint_constants s = plumb_joint_stiffness(w, {index, generation});
  return Writer().add(s.linear).add(s.angular).add(s.linear_damping).add(s.angular_damping).done();
}
PLUMB_EXPORT("joint_read") double* js_joint_read(PLUMB_HANDLE) {
  const plumb_joint_reading r = plumb_joint_read(w, {index, generation});
  return Writer()
      .add(r.force)
      .add(r.torque)
      .add(r.linear_error)
      .add(r.angular_error)
      .add(r.angle)
      .add(r.translation)
      .add(r.length)
      .done();
}
}
