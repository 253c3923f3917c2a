#include "bindings/python/handles.h"

namespace plumb::python {
namespace {

using py::arg;

}  // namespace

void bind_joints(py::module_& module) {
  py::class_<HeldJoint> joint(module, "Joint", traversed<HeldJoint>(), "A joint of two bodies.");
  joint
      .def_property_readonly("valid", PLUMB_READ(HeldJoint, w.valid(h.id)),
                             "False once it was destroyed or broke.")
      .def_property("user_data", PLUMB_READ(HeldJoint, w.user_data(h.id)),
                    PLUMB_SET(HeldJoint, std::uint64_t, w.set_user_data(h.id, value)), "64 bits of your own.")
      .def_property_readonly("kind", PLUMB_READ(HeldJoint, JointKind(w.kind(h.id))),
                             "Its present definition, a copy: plumb.Revolute(...) and the like.")
      .def_property_readonly(
          "definition",
          [](const HeldJoint& h) {
            const JointDefinition d = h.world->visit([&](auto& w) { return w.definition(h.id); });
            return py::dict(arg("kind") = d.kind, arg("collide") = d.collide,
                            arg("break_force") = d.break_force, arg("break_torque") = d.break_torque,
                            arg("user_data") = d.user_data, arg("report_force") = d.report_force,
                            arg("report_torque") = d.report_torque);
          },
          "As at present: a dict of the arguments of World.create_joint but for the bodies.")
      .def_property_readonly(
          "bodies",
          [](const HeldJoint& h) {
            const auto [a, b] = h.world->visit([&](auto& w) { return w.bodies(h.id); });
            return py::make_tuple(HeldBody{h.world, a}, HeldBody{h.world, b});
          },
          "The two bodies, (a, b).")
      .def(
          "change",
          [](const HeldJoint& h, const JointKind& kind) {
            h.world->visit([&](auto& w) { w.change(h.id, kind); });
          },
          arg("kind"), "Sets new speeds, limits and targets, and wakes the bodies.")
      .def(
          "read",
          [](const HeldJoint& h) {
            const JointReading r = h.world->visit([&](auto& w) { return w.read(h.id); });
            return py::dict(arg("force") = r.force, arg("torque") = r.torque,
                            arg("linear_error") = r.linear_error, arg("angular_error") = r.angular_error,
                            arg("angle") = r.angle, arg("translation") = r.translation,
                            arg("length") = r.length);
          },
          "Measurements: force (N), torque (N m), errors (m, rad), angle (rad), translation and length (m).")
      .def(
          "stiffness",
          [](const HeldJoint& h) {
            const JointStiffness s = h.world->visit([&](auto& w) { return w.stiffness(h.id); });
            return py::dict(arg("linear") = s.linear, arg("angular") = s.angular,
                            arg("linear_damping") = s.linear_damping,
                            arg("angular_damping") = s.angular_damping);
          },
          "Constants of its springs: stiffness (N/m, N m/rad) and damping (N s/m, N m s/rad), of the "
          "effective "
          "mass at the pose in which it was created. Raises plumb.Error for a joint without springs.")
      .def(
          "set_load_events",
          [](const HeldJoint& h, double force, double torque) {
            h.world->visit([&](auto& w) { w.set_load_events(h.id, force, torque); });
          },
          arg("force") = 0.0, arg("torque") = 0.0,
          "Sets the loads beyond which it is in World.events['loaded'], N and N m; 0: never.")
      .def(
          "destroy", [](const HeldJoint& h) { h.world->visit([&](auto& w) { w.destroy(h.id); }); },
          "Lets the bodies go.");
  bind_common(joint, "Joint", "Its number among the world's joints; used again once it is destroyed.");
}

}  // namespace plumb::python
