#include "bindings/python/conversion.h"
#include "engine/joints/definitions.h"
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

namespace {

using Pair = std::optional<std::pair<double, double>>;

std::optional<Spring> spring(Pair given) {
  return given ? std::optional(Spring{given->first, given->second}) : std::nullopt;
}
std::optional<Range> range(Pair given) {
  return given ? std::optional(Range{given->first, given->second}) : std::nullopt;
}
std::optional<Motor> motor(Pair given) {
  return given ? std::optional(Motor{given->first, given->second}) : std::nullopt;
}

template <class Kind>
py::class_<Kind> joint(py::module_& module, const char* name, const char* about) {
  return py::class_<Kind>(module, name, about);
}

}  // namespace

void bind_definitions(py::module_& module) {
  using py::arg;
  py::class_<Circle>(module, "Circle", "A disc of `radius`, m.")
      .def(py::init<double>(), arg("radius"))
      .def_readwrite("radius", &Circle::radius, "m");
  py::class_<Box>(module, "Box", "A box of `width` and `height`, m.")
      .def(py::init<double, double>(), arg("width"), arg("height"))
      .def_readwrite("width", &Box::width, "m")
      .def_readwrite("height", &Box::height, "m");
  py::class_<Capsule>(module, "Capsule", "The points no farther than `radius` from a segment, m.")
      .def(py::init<Vec2d, Vec2d, double>(), arg("start"), arg("end"), arg("radius"))
      .def_readwrite("start", &Capsule::start, "m")
      .def_readwrite("end", &Capsule::end, "m")
      .def_readwrite("radius", &Capsule::radius, "m");
  py::class_<Polygon>(module, "Polygon", "The convex hull of 3 to 64 points, rounded by `radius`, m.")
      .def(py::init<std::vector<Vec2d>, double>(), arg("points"), arg("radius") = 0.0)
      .def_readwrite("points", &Polygon::points, "m")
      .def_readwrite("radius", &Polygon::radius, "m");
  py::class_<Segment>(module, "Segment", "A line without thickness and mass, solid from both sides, m.")
      .def(py::init<Vec2d, Vec2d>(), arg("start"), arg("end"))
      .def_readwrite("start", &Segment::start, "m")
      .def_readwrite("end", &Segment::end, "m");

  py::class_<ShapeDefinition>(module, "ShapeDefinition",
                              "A geometry with its pose on a body, density (kg/m^2), material and filter.")
      .def(py::init([](const ShapeGeometry& geometry, Vec2d position, double angle, double density,
                       double friction, double restitution, double rolling_resistance, double surface_speed,
                       std::uint64_t category, std::uint64_t mask, std::int32_t group, bool sensor,
                       bool hit_events, bool pre_solve, std::uint64_t user_data) {
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
      .def_readwrite("geometry", &ShapeDefinition::geometry)
      .def_readwrite("position", &ShapeDefinition::position, "m, in the body's frame")
      .def_readwrite("angle", &ShapeDefinition::angle, "rad, in the body's frame")
      .def_readwrite("density", &ShapeDefinition::density, "kg/m^2")
      .def_property_readonly("friction", [](const ShapeDefinition& d) { return d.material.friction; })
      .def_property_readonly("restitution", [](const ShapeDefinition& d) { return d.material.restitution; })
      .def_readwrite("sensor", &ShapeDefinition::sensor)
      .def_readwrite("hit_events", &ShapeDefinition::hit_events)
      .def_readwrite("pre_solve", &ShapeDefinition::pre_solve)
      .def_readwrite("user_data", &ShapeDefinition::user_data);

  constexpr const char* kRevolute =
      "A common point; the bodies turn about it. limits: (lower, upper), rad; motor: (speed, max_torque), "
      "rad/s and N m; spring: (hertz, damping_ratio).";
  joint<DistanceDefinition>(module, "Distance",
                            "A distance between two anchors: a rod, a spring when `spring` is given, a rope "
                            "when `range` is. Lengths in m, motor: (speed, max_force), m/s and N.")
      .def(py::init([](double length, Vec2d a, Vec2d b, Pair s, Pair r, Pair m) {
             return DistanceDefinition{a, b, length, spring(s), range(r), motor(m)};
           }),
           arg("length") = 1.0, py::kw_only(), arg("anchor_a") = Vec2d{}, arg("anchor_b") = Vec2d{},
           arg("spring") = py::none(), arg("range") = py::none(), arg("motor") = py::none());
  joint<RevoluteDefinition>(module, "Revolute", kRevolute)
      .def(py::init([](Vec2d a, Vec2d b, double reference, Pair l, Pair m, Pair s, double target) {
             return RevoluteDefinition{a, b, reference, range(l), motor(m), spring(s), target};
           }),
           py::kw_only(), arg("anchor_a") = Vec2d{}, arg("anchor_b") = Vec2d{}, arg("reference_angle") = 0.0,
           arg("limits") = py::none(), arg("motor") = py::none(), arg("spring") = py::none(),
           arg("target_angle") = 0.0);
  joint<PrismaticDefinition>(module, "Prismatic",
                             "Slides along an axis of a without turning. limits in m, motor: (speed, "
                             "max_force), m/s and N.")
      .def(
          py::init([](Vec2d axis, Vec2d a, Vec2d b, double reference, Pair l, Pair m, Pair s, double target) {
            return PrismaticDefinition{a, b, axis, reference, range(l), motor(m), spring(s), target};
          }),
          arg("axis") = Vec2d{1, 0}, py::kw_only(), arg("anchor_a") = Vec2d{}, arg("anchor_b") = Vec2d{},
          arg("reference_angle") = 0.0, arg("limits") = py::none(), arg("motor") = py::none(),
          arg("spring") = py::none(), arg("target_translation") = 0.0);
  joint<WeldDefinition>(module, "Weld", "Holds b to a; rigid without springs, (hertz, damping_ratio).")
      .def(py::init([](Vec2d a, Vec2d b, double reference, Pair linear, Pair angular) {
             return WeldDefinition{a, b, reference, spring(linear), spring(angular)};
           }),
           py::kw_only(), arg("anchor_a") = Vec2d{}, arg("anchor_b") = Vec2d{}, arg("reference_angle") = 0.0,
           arg("linear_spring") = py::none(), arg("angular_spring") = py::none());
  joint<WheelDefinition>(module, "Wheel",
                         "A wheel b on a suspension along an axis of a. limits in m, motor: (speed, "
                         "max_torque), rad/s and N m.")
      .def(py::init([](Vec2d axis, Vec2d a, Vec2d b, Pair s, Pair l, Pair m) {
             return WheelDefinition{a, b, axis, spring(s), range(l), motor(m)};
           }),
           arg("axis") = Vec2d{0, 1}, py::kw_only(), arg("anchor_a") = Vec2d{}, arg("anchor_b") = Vec2d{},
           arg("spring") = py::none(), arg("limits") = py::none(), arg("motor") = py::none());
  const MotorDefinition follow;
  joint<MotorDefinition>(module, "Motor",
                         "Drives b towards a pose relative to a with limited force (N) and torque (N m).")
      .def(py::init(
               [](Vec2d position, double angle, double force, double torque, std::pair<double, double> s) {
                 return MotorDefinition{position, angle, force, torque, {s.first, s.second}};
               }),
           py::kw_only(), arg("target_position") = Vec2d{}, arg("target_angle") = 0.0, arg("max_force") = 0.0,
           arg("max_torque") = 0.0,
           arg("spring") = std::pair(follow.spring.hertz, follow.spring.damping_ratio));
  const MouseDefinition drag;
  joint<MouseDefinition>(module, "Mouse",
                         "Pulls a point of b towards a point of the world, m, with at most `max_force`, N.")
      .def(py::init([](Vec2d target, double force, Vec2d b, std::pair<double, double> s) {
             return MouseDefinition{b, target, {s.first, s.second}, force};
           }),
           arg("target"), py::kw_only(), arg("max_force") = 0.0, arg("anchor_b") = Vec2d{},
           arg("spring") = std::pair(drag.spring.hertz, drag.spring.damping_ratio));
  joint<GearDefinition>(module, "Gear", "angle_b = ratio angle_a + phase, rad.")
      .def(py::init([](double ratio, double phase) {
             return GearDefinition{ratio, phase};
           }),
           arg("ratio") = -1.0, arg("phase") = 0.0);
  joint<PulleyDefinition>(module, "Pulley",
                          "A rope over two pulleys: length_a + ratio length_b is constant, m.")
      .def(py::init([](Vec2d ground_a, Vec2d ground_b, Vec2d a, Vec2d b, double ratio,
                       std::optional<double> length) {
             return PulleyDefinition{ground_a, ground_b, a, b, ratio, length};
           }),
           arg("ground_a"), arg("ground_b"), py::kw_only(), arg("anchor_a") = Vec2d{},
           arg("anchor_b") = Vec2d{}, arg("ratio") = 1.0, arg("length") = py::none());
  joint<RatchetDefinition>(module, "Ratchet",
                           "Lets b turn in one direction alone; teeth are `tooth` apart, rad.")
      .def(py::init([](double tooth, double phase) {
             return RatchetDefinition{tooth, phase};
           }),
           arg("tooth") = 0.1, arg("phase") = 0.0);
  joint<FrictionDefinition>(module, "Friction", "Resists motion of b relative to a, N and N m.")
      .def(py::init([](double force, double torque, Vec2d a, Vec2d b) {
             return FrictionDefinition{a, b, force, torque};
           }),
           arg("max_force"), arg("max_torque"), py::kw_only(), arg("anchor_a") = Vec2d{},
           arg("anchor_b") = Vec2d{});
}

}  // namespace plumb::python

PYBIND11_MODULE(_plumb, module) {
  using namespace plumb::python;
  module.doc() = "plumb's engine: see the package plumb.";
  module.attr("__version__") = PLUMB_VERSION;
  bind_errors();
  bind_definitions(module);
  bind_world(module);
  bind_simulation(module);
}
