#include <optional>

#include "bindings/python/handles.h"

namespace plumb::python {
namespace {

using py::arg;

}  // namespace

py::dict reading_of(const WorldReference& held, const ContactReading& c) {
  py::list points, separations, impulses;
  for (int i = 0; i < c.count; ++i)
    points.append(c.points[i]), separations.append(c.separations[i]), impulses.append(c.impulses[i]);
  return py::dict(arg("shape_a") = HeldShape{held, c.shape_a}, arg("shape_b") = HeldShape{held, c.shape_b},
                  arg("normal") = c.normal, arg("points") = points, arg("separations") = separations,
                  arg("impulses") = impulses, arg("approach") = c.approach,
                  arg("step_impulse") = c.step_impulse);
}

void bind_bodies(py::module_& module) {
  py::class_<HeldBody> body(module, "Body", traversed<HeldBody>(),
                            "A body of a world: SI units, angles in rad.");
  body.def_property("position", PLUMB_READ(HeldBody, w.position(h.id)),
                    PLUMB_SET(HeldBody, Vec2d, w.set_position(h.id, value, w.angle(h.id))),
                    "m, of the origin")
      .def_property("angle", PLUMB_READ(HeldBody, w.angle(h.id)),
                    PLUMB_SET(HeldBody, double, w.set_position(h.id, w.position(h.id), value)),
                    "rad, whole turns counted")
      .def_property_readonly("centre", PLUMB_READ(HeldBody, w.centre(h.id)), "m, centre of mass")
      .def_property("velocity", PLUMB_READ(HeldBody, w.velocity(h.id)),
                    PLUMB_SET(HeldBody, Vec2d, w.set_velocity(h.id, value)), "m/s, of the centre of mass")
      .def_property("angular_velocity", PLUMB_READ(HeldBody, w.angular_velocity(h.id)),
                    PLUMB_SET(HeldBody, double, w.set_angular_velocity(h.id, value)), "rad/s")
      .def_property(
          "type",
          [](const HeldBody& h) {
            return h.world->visit([&](auto& w) { return name_in(kBodyTypes, w.type(h.id)); });
          },
          [](const HeldBody& h, const std::string& type) {
            const auto value = named<BodyType>(kBodyTypes, type, "type");
            h.world->visit([&](auto& w) { w.set_type(h.id, value); });
          },
          "'static', 'kinematic' or 'dynamic'")
      .def_property_readonly("mass", PLUMB_READ(HeldBody, w.mass(h.id)), "kg, 0 unless dynamic")
      .def_property_readonly("inertia", PLUMB_READ(HeldBody, w.inertia(h.id)),
                             "kg m^2 about the centre of mass")
      .def_property("gravity_scale", PLUMB_READ(HeldBody, w.gravity_scale(h.id)),
                    PLUMB_SET(HeldBody, double, w.set_gravity_scale(h.id, value)),
                    "Factor of gravity on it, 1 unless set.")
      .def_property("linear_damping", PLUMB_READ(HeldBody, w.linear_damping(h.id)),
                    PLUMB_SET(HeldBody, double, w.set_damping(h.id, value, w.angular_damping(h.id))), "1/s")
      .def_property("angular_damping", PLUMB_READ(HeldBody, w.angular_damping(h.id)),
                    PLUMB_SET(HeldBody, double, w.set_damping(h.id, w.linear_damping(h.id), value)), "1/s")
      .def_property("awake", PLUMB_READ(HeldBody, w.awake(h.id)),
                    PLUMB_SET(HeldBody, Flag, w.set_awake(h.id, value)),
                    "False while it sleeps; wakes it, or lets it sleep, when set.")
      .def_property("may_sleep", PLUMB_READ(HeldBody, w.may_sleep(h.id)),
                    PLUMB_SET(HeldBody, Flag, w.set_may_sleep(h.id, value)), "False keeps it awake.")
      .def_property("user_data", PLUMB_READ(HeldBody, w.user_data(h.id)),
                    PLUMB_SET(HeldBody, std::uint64_t, w.set_user_data(h.id, value)), "64 bits of your own.")
      .def_property("continuous", PLUMB_READ(HeldBody, w.continuous(h.id)),
                    PLUMB_SET(HeldBody, Flag, w.set_continuous(h.id, value)),
                    "False lets it tunnel, to save time.")
      .def_property("enabled", PLUMB_READ(HeldBody, w.enabled(h.id)),
                    PLUMB_SET(HeldBody, Flag, w.set_enabled(h.id, value)),
                    "False takes the body out of the simulation until it is set again.")
      .def_property_readonly(
          "box",
          [](const HeldBody& h) {
            const Aabb<double> box = h.world->visit([&](auto& w) { return w.box(h.id); });
            return py::make_tuple(box.lower, box.upper);
          },
          "lower and upper corner of the box around its shapes, m")
      .def_property("name", PLUMB_READ(HeldBody, std::string(w.name(h.id))),
                    PLUMB_SET(HeldBody, const std::string&, w.set_name(h.id, value)),
                    "In messages and drawings; '' unless given.")
      .def_property_readonly("valid", PLUMB_READ(HeldBody, w.valid(h.id)), "False once it was destroyed.")
      .def_property_readonly("quarantined", PLUMB_READ(HeldBody, w.quarantined(h.id)),
                             "True while it is out of the simulation for a number that was not finite.")
      .def_property_readonly("shapes", PLUMB_READ(HeldBody, handles(h.world, w.shapes(h.id))),
                             "Its shapes, with those of chains.")
      .def_property_readonly("joints", PLUMB_READ(HeldBody, handles(h.world, w.joints(h.id))), "Its joints.")
      .def(
          "contacts",
          [](const HeldBody& h) {
            return h.world->visit([&](auto& w) {
              py::list all;
              for (const ContactReading& c : w.contacts(h.id)) all.append(reading_of(h.world, c));
              return all;
            });
          },
          "Contacts with points, as dicts; impulses in N s, of the last substep; step_impulse of the whole "
          "step, for "
          "shapes with hit_events or pre_solve.")
      .def(
          "apply_force",
          [](const HeldBody& h, Vec2d force, std::optional<Vec2d> point) {
            h.world->visit(
                [&](auto& w) { point ? w.apply_force(h.id, force, *point) : w.apply_force(h.id, force); });
          },
          arg("force"), arg("point") = py::none(),
          "Applies a force, N, during the next step; at the centre of mass or a point of the world, m.")
      .def("apply_torque", PLUMB_SET(HeldBody, double, w.apply_torque(h.id, value)), arg("torque"),
           "N m, during the next step.")
      .def(
          "apply_impulse",
          [](const HeldBody& h, Vec2d impulse, std::optional<Vec2d> point) {
            h.world->visit([&](auto& w) {
              point ? w.apply_impulse(h.id, impulse, *point) : w.apply_impulse(h.id, impulse);
            });
          },
          arg("impulse"), arg("point") = py::none(), "Applies an impulse, N s, at once.")
      .def("apply_angular_impulse", PLUMB_SET(HeldBody, double, w.apply_angular_impulse(h.id, value)),
           arg("impulse"), "N m s, at once.")
      .def(
          "move_towards",
          [](const HeldBody& h, Vec2d position, double angle, double dt) {
            h.world->visit([&](auto& w) { w.move_towards(h.id, position, angle, dt); });
          },
          arg("position"), arg("angle"), arg("dt"),
          "Sets the velocities such that it reaches the pose after dt, s.")
      .def(
          "set_pose",
          [](const HeldBody& h, Vec2d position, double angle) {
            h.world->visit([&](auto& w) { w.set_position(h.id, position, angle); });
          },
          arg("position"), arg("angle"), "Teleports the origin, m, and sets the angle, rad.")
      .def(
          "set_mass",
          [](const HeldBody& h, double mass, double inertia, Vec2d centre) {
            h.world->visit([&](auto& w) { w.set_mass(h.id, {mass, centre, inertia}); });
          },
          arg("mass"), arg("inertia"), arg("centre") = Vec2d{}, "kg, kg m^2, m")
      .def(
          "use_densities", [](const HeldBody& h) { h.world->visit([&](auto& w) { w.use_densities(h.id); }); },
          "Computes the mass from the shapes again.")
      .def(
          "set_locks",
          [](const HeldBody& h, Flag x, Flag y, Flag rotation) {
            h.world->visit([&](auto& w) { w.set_locks(h.id, x, y, rotation); });
          },
          arg("x") = false, arg("y") = false, arg("rotation") = false,
          "Lets it not move along x or y, or not turn. What is not given is free.")
      .def_property_readonly(
          "locks",
          [](const HeldBody& h) {
            const BodyLocks locks = h.world->visit([&](auto& w) { return w.locks(h.id); });
            return py::make_tuple(locks.x, locks.y, locks.rotation);
          },
          "x, y and rotation, as set_locks sets them")
      .def(
          "world_point",
          [](const HeldBody& h, Vec2d local) {
            return h.world->visit([&](auto& w) { return w.world_point(h.id, local); });
          },
          arg("local"), "m, in the world, of a point in the body's frame.")
      .def(
          "local_point",
          [](const HeldBody& h, Vec2d point) {
            return h.world->visit([&](auto& w) { return w.local_point(h.id, point); });
          },
          arg("world"), "m, in the body's frame, of a point of the world.")
      .def(
          "velocity_at",
          [](const HeldBody& h, Vec2d point) {
            return h.world->visit([&](auto& w) { return w.velocity_at(h.id, point); });
          },
          arg("point"), "m/s, of the body at a point of the world, m.")
      .def(
          "create_shape",
          [](const HeldBody& h, const std::variant<ShapeDefinition, ShapeGeometry>& shape) {
            const ShapeDefinition d = definition_of(shape);
            return HeldShape{h.world, h.world->visit([&](auto& w) { return w.create_shape(h.id, d); })};
          },
          arg("shape"), "Adds a shape: a geometry or a ShapeDefinition.")
      .def(
          "create_chain",
          [](const HeldBody& h, std::vector<Vec2d> points, Flag closed, double friction, double restitution,
             double rolling_resistance, double surface_speed, std::uint64_t category, std::uint64_t mask,
             std::int32_t group, Flag sensor, Flag hit_events, Flag pre_solve, std::uint64_t user_data,
             std::vector<Material> materials) {
            ChainDefinition d;
            d.materials = std::move(materials);
            d.points = std::move(points), d.closed = closed;
            d.material = {friction, restitution, rolling_resistance, surface_speed};
            d.filter = {category, mask, group};
            d.sensor = sensor, d.hit_events = hit_events, d.pre_solve = pre_solve, d.user_data = user_data;
            return HeldChain{h.world, h.world->visit([&](auto& w) { return w.create_chain(h.id, d); })};
          },
          arg("points"), arg("closed") = false, py::kw_only(), arg("friction") = Material{}.friction,
          arg("restitution") = 0.0, arg("rolling_resistance") = 0.0, arg("surface_speed") = 0.0,
          arg("category") = Filter{}.category, arg("mask") = Filter{}.mask, arg("group") = 0,
          arg("sensor") = false, arg("hit_events") = false, arg("pre_solve") = false, arg("user_data") = 0,
          arg("materials") = std::vector<Material>{},
          "Adds a line of one-sided segments through points, m; the front is to the right when walking along "
          "it. The rest is that of its segments; surface_speed: m/s; materials: one plumb.Material for each "
          "of them, "
          "in place of friction and the like.")
      .def(
          "release", [](const HeldBody& h) { h.world->visit([&](auto& w) { w.release(h.id); }); },
          "Releases it from quarantine.")
      .def(
          "destroy", [](const HeldBody& h) { h.world->visit([&](auto& w) { w.destroy(h.id); }); },
          "Destroys it with its shapes, contacts and joints.");
  bind_common(body, "Body", "Its row in the world's arrays.");
}

}  // namespace plumb::python
