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

}  // namespace

extern "C" {

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
