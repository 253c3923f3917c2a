#include "bindings/python/handles.h"
#include "engine/world/queries.h"

namespace plumb::python {
namespace {

using py::arg;

py::dict definition_of_chain(const HeldChain& h) {
  const ChainDefinition d = h.world->visit([&](auto& w) { return w.definition(h.id); });
  return py::dict(arg("points") = d.points, arg("closed") = d.closed, arg("friction") = d.material.friction,
                  arg("restitution") = d.material.restitution,
                  arg("rolling_resistance") = d.material.rolling_resistance,
                  arg("surface_speed") = d.material.surface_speed, arg("materials") = d.materials,
                  arg("category") = d.filter.category, arg("mask") = d.filter.mask,
                  arg("group") = d.filter.group, arg("sensor") = d.sensor, arg("hit_events") = d.hit_events,
                  arg("pre_solve") = d.pre_solve, arg("user_data") = d.user_data);
}

}  // namespace

void bind_shapes(py::module_& module) {
  py::class_<HeldShape> shape(module, "Shape", traversed<HeldShape>(), "A shape of a body.");
  shape
      .def_property_readonly("body", PLUMB_READ(HeldShape, (HeldBody{h.world, w.body(h.id)})),
                             "The body that it is of.")
      .def_property_readonly("valid", PLUMB_READ(HeldShape, w.valid(h.id)), "False once it was destroyed.")
      .def_property_readonly("definition", PLUMB_READ(HeldShape, w.definition(h.id)),
                             "As at present; a box is a polygon.")
      .def_property("user_data", PLUMB_READ(HeldShape, w.user_data(h.id)),
                    PLUMB_SET(HeldShape, std::uint64_t, w.set_user_data(h.id, value)), "64 bits of your own.")
      .def_property("density", PLUMB_READ(HeldShape, w.density(h.id)),
                    PLUMB_SET(HeldShape, double, w.set_density(h.id, value)), "kg/m^2")
      .def_property("sensor", PLUMB_READ(HeldShape, w.sensor(h.id)),
                    PLUMB_SET(HeldShape, Flag, w.set_sensor(h.id, value)),
                    "Feels what is in it, and collides with nothing.")
      .def_property("hit_events", PLUMB_READ(HeldShape, w.hit_events(h.id)),
                    PLUMB_SET(HeldShape, Flag, w.set_hit_events(h.id, value)),
                    "Hard impacts on it are reported.")
      .def_property("pre_solve", PLUMB_READ(HeldShape, w.pre_solve(h.id)),
                    PLUMB_SET(HeldShape, Flag, w.set_pre_solve(h.id, value)), "Its contacts call the hook.")
      .def_property_readonly(
          "box",
          [](const HeldShape& h) {
            const Aabb<double> box = h.world->visit([&](auto& w) { return w.box(h.id); });
            return py::make_tuple(box.lower, box.upper);
          },
          "lower and upper corner, m")
      .def_property_readonly(
          "chain",
          [](const HeldShape& h) -> py::object {
            const ChainId id = h.world->visit([&](auto& w) { return w.chain(h.id); });
            if (!h.world->visit([&](auto& w) { return w.valid(id); })) return py::none();
            return py::cast(HeldChain{h.world, id});
          },
          "The chain of a segment, or None.")
      .def(
          "ray_cast",
          [](const HeldShape& h, Vec2d origin, Vec2d translation) -> py::object {
            const auto hit = h.world->visit([&](auto& w) { return ray_cast(w, h.id, origin, translation); });
            if (!hit) return py::none();
            return py::dict(arg("point") = hit->point, arg("normal") = hit->normal,
                            arg("fraction") = hit->fraction);
          },
          arg("origin"), arg("translation"),
          "The hit of a ray (m) with this shape alone, a dict of point, normal and fraction, or None.")
      .def(
          "contains",
          [](const HeldShape& h, Vec2d point) {
            return h.world->visit([&](auto& w) { return contains(w, h.id, point); });
          },
          arg("point"), "True for a point of the world, m, in this shape.")
      .def(
          "distance",
          [](const HeldShape& h, const HeldShape& other) {
            const ShapeId to = id_in(h.world, other, "other");
            const ShapeDistance d = h.world->visit([&](auto& w) { return distance(w, h.id, to); });
            return py::dict(arg("distance") = d.distance, arg("point_a") = d.point_a,
                            arg("point_b") = d.point_b, arg("normal") = d.normal);
          },
          arg("other"),
          "Distance to another shape, m, negative: the least translation that separates them; a dict with "
          "the "
          "nearest points of this and the other one, and the normal from this to it.")
      .def(
          "set_geometry",
          [](const HeldShape& h, const ShapeGeometry& geometry, Vec2d position, double angle) {
            h.world->visit([&](auto& w) { w.set_geometry(h.id, geometry, position, angle); });
          },
          arg("geometry"), arg("position") = Vec2d{}, arg("angle") = 0.0,
          "Replaces the geometry, which lies in the body's frame (m, rad); all else stays. Its contacts end, "
          "and begin anew in the next step. Refused for a segment of a chain.")
      .def(
          "contact",
          [](const HeldShape& h, const HeldShape& other) -> py::object {
            const ShapeId to = id_in(h.world, other, "other");
            const auto found = h.world->visit([&](auto& w) { return w.contact(h.id, to); });
            return found ? py::object(reading_of(h.world, *found)) : py::none();
          },
          arg("other"),
          "The contact with another shape, a dict, or None. After a begin event its normal and separations "
          "are those at the beginning of the step that made it, its impulses those of that step.")
      .def_property("material", PLUMB_READ(HeldShape, w.material(h.id)),
                    PLUMB_SET(HeldShape, const Material&, w.set_material(h.id, value)),
                    "Friction and the like, as a whole.")
      .def_property_readonly("overlapping", PLUMB_READ(HeldShape, handles(h.world, w.overlapping(h.id))),
                             "Shapes in a sensor in the last step.")
      .def_property("friction", PLUMB_READ(HeldShape, w.material(h.id).friction),
                    PLUMB_SET(HeldShape, double, auto m = w.material(h.id); m.friction = value;
                              w.set_material(h.id, m)),
                    "Coulomb's coefficient, at least 0")
      .def_property("restitution", PLUMB_READ(HeldShape, w.material(h.id).restitution),
                    PLUMB_SET(HeldShape, double, auto m = w.material(h.id); m.restitution = value;
                              w.set_material(h.id, m)),
                    "Newton's coefficient, 0 to 1")
      .def_property("surface_speed", PLUMB_READ(HeldShape, w.material(h.id).surface_speed),
                    PLUMB_SET(HeldShape, double, auto m = w.material(h.id); m.surface_speed = value;
                              w.set_material(h.id, m)),
                    "m/s")
      .def_property("rolling_resistance", PLUMB_READ(HeldShape, w.material(h.id).rolling_resistance),
                    PLUMB_SET(HeldShape, double, auto m = w.material(h.id); m.rolling_resistance = value;
                              w.set_material(h.id, m)),
                    "lever arm over the rounding radius, at least 0")
      .def_property_readonly(
          "filter",
          [](const HeldShape& h) {
            const Filter f = h.world->visit([&](auto& w) { return w.filter(h.id); });
            return py::make_tuple(f.category, f.mask, f.group);
          },
          "(category, mask, group), as set_filter sets them")
      .def(
          "set_filter",
          [](const HeldShape& h, std::uint64_t category, std::uint64_t mask, std::int32_t group) {
            h.world->visit([&](auto& w) { w.set_filter(h.id, {category, mask, group}); });
          },
          arg("category") = Filter{}.category, arg("mask") = Filter{}.mask, arg("group") = 0,
          "64 bits each: shapes touch if each one's category is in the other's mask; an equal group other "
          "than 0 decides.")
      .def(
          "destroy", [](const HeldShape& h) { h.world->visit([&](auto& w) { w.destroy(h.id); }); },
          "Destroys it with its contacts.");
  bind_common(shape, "Shape",
              "Its number among the world's shapes, as in World.contacts; used again once it is destroyed.");

  py::class_<HeldChain> chain(module, "Chain", traversed<HeldChain>(), "A chain of segments of a body.");
  chain.def_property_readonly("valid", PLUMB_READ(HeldChain, w.valid(h.id)), "False once it was destroyed.")
      .def_property_readonly("body", PLUMB_READ(HeldChain, (HeldBody{h.world, w.body(h.id)})),
                             "The body that it is of.")
      .def_property_readonly("segments", PLUMB_READ(HeldChain, handles(h.world, w.segments(h.id))),
                             "Its shapes, in order.")
      .def_property_readonly("definition", &definition_of_chain,
                             "As at present: a dict of the arguments of Body.create_chain. Filter and flags "
                             "are those of the first segment.")
      .def(
          "destroy", [](const HeldChain& h) { h.world->visit([&](auto& w) { w.destroy(h.id); }); },
          "Destroys it with its segments.");
  bind_common(chain, "Chain", "Its number among the world's chains; used again once it is destroyed.");
}

}  // namespace plumb::python
