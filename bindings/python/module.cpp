#include "bindings/python/collected.h"
#include "bindings/python/conversion.h"
#include "engine/world/definitions.h"

namespace plumb::python {

/// Raises the class of plumb._errors for an error, with its parts as attributes.
void bind_errors() {
  // Never destroyed: Python is gone by then.
  static const auto& classes = *new py::object(py::module_::import("plumb._errors").attr("CLASSES"));
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      const py::object type = classes[py::int_(static_cast<int>(error.kind()))];
      const py::object raised = type(error.what());
      raised.attr("subject") = error.subject();
      raised.attr("field") = error.field();
      raised.attr("value") = error.value();
      raised.attr("problem") = error.problem();
      raised.attr("line") = error.line();
      PyErr_SetObject(type.ptr(), raised.ptr());
    }
  });
}

/// Returns the call that makes an object of these attributes.
std::string repr_of(const py::object& object, const std::vector<const char*>& fields) {
  std::string text;
  for (const char* field : fields)
    text += (text.empty() ? "" : ", ") + std::string(field) + "=" +
            std::string(py::str(py::repr(object.attr(field))));
  return "plumb." + std::string(py::str(py::type::of(object).attr("__name__"))) + "(" + text + ")";
}
const std::vector<const char*> kShapeFields{
    "geometry",           "position",      "angle",    "density", "friction", "restitution",
    "rolling_resistance", "surface_speed", "category", "mask",    "group",    "sensor",
    "hit_events",         "pre_solve",     "user_data"};

void bind_definitions(py::module_& module) {
  using py::arg;
  py::class_<Circle>(module, "Circle", "A disc of `radius`, m.")
      .def(py::init<double>(), arg("radius"))
      .def_readwrite("radius", &Circle::radius, "m")
      .def("__repr__", [](const py::object& g) { return repr_of(g, {"radius"}); });
  py::class_<Box>(module, "Box", "A box of `width` and `height`, m.")
      .def(py::init<double, double>(), arg("width"), arg("height"))
      .def_readwrite("width", &Box::width, "m")
      .def_readwrite("height", &Box::height, "m")
      .def("__repr__", [](const py::object& g) {
        return repr_of(g, {"width", "height"});
      });
  py::class_<Capsule>(module, "Capsule", "The points no farther than `radius` from a segment, m.")
      .def(py::init<Vec2d, Vec2d, double>(), arg("start"), arg("end"), arg("radius"))
      .def_readwrite("start", &Capsule::start, "m")
      .def_readwrite("end", &Capsule::end, "m")
      .def_readwrite("radius", &Capsule::radius, "m")
      .def("__repr__", [](const py::object& g) {
        return repr_of(g, {"start", "end", "radius"});
      });
  py::class_<Polygon>(module, "Polygon",
                      "The convex hull of 3 or more points, of at most 64 corners, rounded by `radius`, m.")
      .def(py::init<std::vector<Vec2d>, double>(), arg("points"), arg("radius") = 0.0)
      .def_readwrite("points", &Polygon::points, "m")
      .def_readwrite("radius", &Polygon::radius, "m")
      .def("__repr__", [](const py::object& g) {
        return repr_of(g, {"points", "radius"});
      });
  py::class_<Segment>(module, "Segment", "A line without thickness and mass, solid from both sides, m.")
      .def(py::init<Vec2d, Vec2d>(), arg("start"), arg("end"))
      .def_readwrite("start", &Segment::start, "m")
      .def_readwrite("end", &Segment::end, "m")
      .def("__repr__", [](const py::object& g) {
        return repr_of(g, {"start", "end"});
      });

  py::class_<Material>(module, "Material", "What a surface is of.")
      .def(py::init([](double friction, double restitution, double rolling_resistance, double surface_speed) {
             return Material{friction, restitution, rolling_resistance, surface_speed};
           }),
           arg("friction") = Material{}.friction, arg("restitution") = 0.0, arg("rolling_resistance") = 0.0,
           arg("surface_speed") = 0.0)
      .def_readwrite("friction", &Material::friction, "Coulomb's coefficient, at least 0")
      .def_readwrite("restitution", &Material::restitution, "Newton's coefficient, 0 to 1")
      .def_readwrite("rolling_resistance", &Material::rolling_resistance,
                     "lever arm over the rounding radius, at least 0")
      .def_readwrite("surface_speed", &Material::surface_speed, "m/s")
      .def(
          "__eq__", [](const Material& a, const Material& b) { return a == b; }, py::is_operator())
      .def("__repr__", [](const py::object& m) {
        return repr_of(m, {"friction", "restitution", "rolling_resistance", "surface_speed"});
      });
  py::class_<ShapeDefinition>(module, "ShapeDefinition",
                              "A geometry with its pose on a body, density (kg/m^2), material and filter.")
      .def(py::init([](const ShapeGeometry& geometry, Vec2d position, double angle, double density,
                       double friction, double restitution, double rolling_resistance, double surface_speed,
                       std::uint64_t category, std::uint64_t mask, std::int32_t group, Flag sensor,
                       Flag hit_events, Flag pre_solve, std::uint64_t user_data) {
             return ShapeDefinition{geometry,
                                    position,
                                    angle,
                                    density,
                                    {friction, restitution, rolling_resistance, surface_speed},
                                    {category, mask, group},
                                    sensor,
                                    hit_events,
                                    pre_solve,
                                    user_data};
           }),
           arg("geometry"), py::kw_only(), arg("position") = Vec2d{}, arg("angle") = 0.0,
           arg("density") = 1.0, arg("friction") = Material{}.friction, arg("restitution") = 0.0,
           arg("rolling_resistance") = 0.0, arg("surface_speed") = 0.0, arg("category") = Filter{}.category,
           arg("mask") = Filter{}.mask, arg("group") = 0, arg("sensor") = false, arg("hit_events") = false,
           arg("pre_solve") = false, arg("user_data") = 0)
      .def_readwrite("geometry", &ShapeDefinition::geometry, "Circle, Box, Capsule, Polygon or Segment.")
      .def_readwrite("position", &ShapeDefinition::position, "m, in the body's frame")
      .def_readwrite("angle", &ShapeDefinition::angle, "rad, in the body's frame")
      .def_readwrite("density", &ShapeDefinition::density, "kg/m^2")
      .def_property_readonly(
          "friction", [](const ShapeDefinition& d) { return d.material.friction; },
          "Coulomb's coefficient, at least 0")
      .def_property_readonly(
          "restitution", [](const ShapeDefinition& d) { return d.material.restitution; },
          "Newton's coefficient, 0 to 1")
      .def_property_readonly(
          "rolling_resistance", [](const ShapeDefinition& d) { return d.material.rolling_resistance; },
          "lever arm over the rounding radius, at least 0")
      .def_property_readonly(
          "surface_speed", [](const ShapeDefinition& d) { return d.material.surface_speed; }, "m/s")
      .def_property_readonly(
          "category", [](const ShapeDefinition& d) { return d.filter.category; }, "64 bits")
      .def_property_readonly(
          "mask", [](const ShapeDefinition& d) { return d.filter.mask; },
          "64 bits: categories that it touches")
      .def_property_readonly(
          "group", [](const ShapeDefinition& d) { return d.filter.group; },
          "of equal groups other than 0, positive ones touch and negative ones do not")
      .def_property(
          "sensor", [](const ShapeDefinition& d) { return d.sensor; },
          [](ShapeDefinition& d, Flag on) { d.sensor = on; },
          "Feels what is in it, and collides with nothing.")
      .def_property(
          "hit_events", [](const ShapeDefinition& d) { return d.hit_events; },
          [](ShapeDefinition& d, Flag on) { d.hit_events = on; }, "Hard impacts on it are reported.")
      .def_property(
          "pre_solve", [](const ShapeDefinition& d) { return d.pre_solve; },
          [](ShapeDefinition& d, Flag on) { d.pre_solve = on; }, "Its contacts call the hook.")
      .def_readwrite("user_data", &ShapeDefinition::user_data, "64 bits of your own.")
      .def("__repr__", [](const py::object& d) { return repr_of(d, kShapeFields); });
}

/// Refuses calls of objects that were made by `__new__` alone: pybind11 would pass memory that nothing has
/// written.
void refuse_uninitialised_objects(const py::module_& module) {
  for (const auto& [name, each] : py::dict(module.attr("__dict__"))) {
    if (!PyType_Check(each.ptr())) continue;
    auto* const info = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(each.ptr()));
    if (info != nullptr) info->operator_new = [](std::size_t) -> void* { refuse_uninitialised(); };
  }
}

}  // namespace plumb::python

PYBIND11_MODULE(_plumb, module) {
  using namespace plumb::python;
  module.doc() = "plumb's engine: see the package plumb.";
  module.attr("__version__") = PLUMB_VERSION;
  bind_errors();
  bind_definitions(module);
  bind_joint_kinds(module);
  bind_world(module);
  bind_simulation(module);
  refuse_uninitialised_objects(module);
  explain_wrong_arguments(module);
}
