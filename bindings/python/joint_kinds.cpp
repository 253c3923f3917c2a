#include <optional>
#include <string>
#include <utility>

#include "bindings/python/conversion.h"
#include "engine/joints/definitions.h"
#include "engine/scene/joint_fields.h"

namespace plumb::python {
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

py::object as_python(Vec2d v) { return py::cast(v); }
py::object as_python(double number) { return py::float_(number); }
py::object as_python(const Spring& s) { return py::make_tuple(s.hertz, s.damping_ratio); }
py::object as_python(const Range& r) { return py::make_tuple(r.lower, r.upper); }
py::object as_python(const Motor& m) { return py::make_tuple(m.speed, m.max_force); }
template <class Value>
py::object as_python(const std::optional<Value>& value) {
  return value ? as_python(*value) : py::none();
}

/// Calls `visit(name, value)` for all that a kind of joint is created from.
template <class Kind, class Visit>
void for_each_field(const Kind& kind, Visit&& visit) {
  const auto field = [&](const char* name, const auto& value, const FieldRule& rule) {
    visit(name, value, rule);
  };
  anchor_fields(kind, field), own_fields(kind, field);
}

template <class Kind>
py::dict fields_of(const Kind& kind) {
  py::dict all;
  for_each_field(
      kind, [&](const char* name, const auto& value, const FieldRule&) { all[name] = as_python(value); });
  return all;
}

/// Makes the class of a kind of joint: its arguments can be read, but not set, since a kind is a copy of what
/// the joint has.
template <class Kind>
py::class_<Kind> joint(py::module_& module, const char* name, const char* about) {
  py::class_<Kind> type(module, name, about);
  for_each_field(Kind{}, [&](const char* field, const auto&, const FieldRule& rule) {
    type.def_property_readonly(
        field, [field](const Kind& kind) -> py::object { return fields_of(kind)[field]; },
        rule.unit != nullptr && *rule.unit != '\0' ? rule.unit : "without a unit, or (hertz, damping ratio)");
  });
  type.def("__repr__", [name](const Kind& kind) {
    std::string text;
    for (const auto& [field, value] : fields_of(kind))
      text += (text.empty() ? "" : ", ") + std::string(py::str(field)) + "=" + std::string(py::repr(value));
    return "plumb." + std::string(name) + "(" + text + ")";
  });
  type.def(
      "replace",
      [](const py::object& self, const py::kwargs& changes) {
        py::dict all = fields_of(self.cast<const Kind&>());
        for (const auto& [field, value] : changes) all[field] = value;
        return py::type::of(self)(**all);
      },
      "Returns a copy in which the given arguments differ.");
  return type;
}

}  // namespace

void bind_joint_kinds(py::module_& module) {
  using py::arg;
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
