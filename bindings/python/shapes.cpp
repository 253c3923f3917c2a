#include "bindings/python/handles.h"

namespace plumb::python {
namespace {

using py::arg;

}  // namespace

void bind_shapes(py::module_& module) {
  py::class_<HeldShape> shape(module, "Shape", "A shape of a body.");
  shape.def_property_readonly("body", PLUMB_READ(HeldShape, (HeldBody{h.world, w.body(h.id)})))
      .def_property_readonly("valid", PLUMB_READ(HeldShape, w.valid(h.id)))
      .def_property_readonly("definition", PLUMB_READ(HeldShape, w.definition(h.id)),
                             "As at present; a box is a polygon.")
      .def_property("user_data", PLUMB_READ(HeldShape, w.user_data(h.id)),
                    PLUMB_SET(HeldShape, std::uint64_t, w.set_user_data(h.id, value)))
      .def_property("density", PLUMB_READ(HeldShape, w.density(h.id)),
                    PLUMB_SET(HeldShape, double, w.set_density(h.id, value)), "kg/m^2")
      .def_property("sensor", PLUMB_READ(HeldShape, w.sensor(h.id)),
                    PLUMB_SET(HeldShape, bool, w.set_sensor(h.id, value)))
      .def_property_readonly("overlapping", PLUMB_READ(HeldShape, handles(h.world, w.overlapping(h.id))),
                             "Shapes in a sensor in the last step.")
      .def_property("friction", PLUMB_READ(HeldShape, w.material(h.id).friction),
                    PLUMB_SET(HeldShape, double, auto m = w.material(h.id); m.friction = value;
                              w.set_material(h.id, m)))
      .def_property("restitution", PLUMB_READ(HeldShape, w.material(h.id).restitution),
                    PLUMB_SET(HeldShape, double, auto m = w.material(h.id); m.restitution = value;
                              w.set_material(h.id, m)))
      .def_property("surface_speed", PLUMB_READ(HeldShape, w.material(h.id).surface_speed),
                    PLUMB_SET(HeldShape, double, auto m = w.material(h.id); m.surface_speed = value;
                              w.set_material(h.id, m)),
                    "m/s")
      .def(
          "set_filter",
          [](const HeldShape& h, std::uint32_t category, std::uint32_t mask, std::int32_t group) {
            h.world->visit([&](auto& w) { w.set_filter(h.id, {category, mask, group}); });
          },
          arg("category") = 1u, arg("mask") = 0xFFFFFFFFu, arg("group") = 0)
      .def("destroy", [](const HeldShape& h) { h.world->visit([&](auto& w) { w.destroy(h.id); }); });
  bind_common(shape, "Shape");

  py::class_<HeldChain> chain(module, "Chain", "A chain of segments of a body.");
  chain.def_property_readonly("valid", PLUMB_READ(HeldChain, w.valid(h.id)))
      .def_property_readonly("segments", PLUMB_READ(HeldChain, handles(h.world, w.segments(h.id))))
      .def("destroy", [](const HeldChain& h) { h.world->visit([&](auto& w) { w.destroy(h.id); }); });
  bind_common(chain, "Chain");
}

}  // namespace plumb::python
