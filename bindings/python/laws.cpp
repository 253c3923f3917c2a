#include <array>
#include <optional>

#include "bindings/python/considered.h"
#include "bindings/python/handles.h"
#include "engine/world/force_laws.h"

namespace plumb::python {
namespace {

using py::arg;
using Wrenches = py::array_t<double, py::array::c_style | py::array::forcecast>;

constexpr std::array<const char*, 2> kFalloffs = {"inverse_square", "linear"};

/// Adds a law with its options: `call(world, options)`.
template <class Call>
void apply(const WorldPointer& held, bool wakes, Call&& call) {
  held->visit([&](auto& w) { call(w, LawOptions{wakes}); });
}

/// State of a body, as passed to a law.
struct HeldLawBody {
  HeldBody body;
  LawBody state;
  template <class Visit>
  void traverse(Visit&& visit) const {
    body.traverse(visit);
  }
};

/// Applies a function of a body's state that returns (x, y, torque).
void apply_function(const WorldPointer& held, const std::function<py::object(HeldLawBody)>& law, double dt,
                    Flag wakes) {
  const WorldReference world = held;
  held->visit([&](auto& w) {
    plumb::apply_law(w,
                     [&](const LawBody& body) {
                       const auto [x, y, torque] = returned<std::tuple<double, double, double>>(
                           law(HeldLawBody{{world, body.id}, body}), "a law",
                           "(x, y, torque), three numbers");
                       return Wrench<double>{{x, y}, torque};
                     },
                     {wakes, dt});
  });
}

void bind_law_body(py::module_& module) {
  const auto state = [](auto member) { return [member](const HeldLawBody& b) { return b.state.*member; }; };
  py::class_<HeldLawBody>(module, "LawBody", traversed<HeldLawBody>(),
                          "State of a body, as passed to a law: SI units, angles in rad.")
      .def_readonly("body", &HeldLawBody::body, "Its handle.")
      .def_property_readonly("centre", state(&LawBody::centre), "m, of mass, (x, y).")
      .def_property_readonly("angle", state(&LawBody::angle), "rad.")
      .def_property_readonly("velocity", state(&LawBody::velocity), "m/s, of the centre of mass, (x, y).")
      .def_property_readonly("angular_velocity", state(&LawBody::angular_velocity), "rad/s.")
      .def_property_readonly("mass", state(&LawBody::mass), "kg.")
      .def_property_readonly("inertia", state(&LawBody::inertia), "kg m^2, about the centre of mass.")
      .def_property_readonly("user_data", state(&LawBody::user_data), "64 bits of your own.");
}

/// Applies an array with a row of each body, by its index.
void apply_rows(const WorldPointer& held, const Wrenches& rows, Flag wakes) {
  const auto wanted = held->visit([](auto& w) { return static_cast<py::ssize_t>(w.data().bodies.size()); });
  if (rows.ndim() != 2 || rows.shape(0) != wanted || rows.shape(1) != 3) {
    throw Error(Error::Kind::Value, "wrenches", "shape", "another one",
                "must be (" + std::to_string(wanted) + ", 3): x, y (N) and torque (N m) of each body");
  }
  apply(held, wakes, [&](auto& w, LawOptions options) {
    plumb::apply_law(
        w,
        [&](const LawBody& body) {
          const double* row = rows.data(static_cast<py::ssize_t>(body.id.index), 0);
          return Wrench<double>{{row[0], row[1]}, row[2]};
        },
        options);
  });
}

}  // namespace

void bind_laws(py::module_& module, HeldWorldClass& world) {
  bind_law_body(module);
  world
      .def("apply_law", &apply_function, arg("law"), py::kw_only(), arg("dt") = 1.0 / 60,
           arg("wakes") = false,
           "Adds the forces of the next step: law(body) returns (x, y, torque), N and N m about the centre "
           "of mass. It sees bodies as at the middle of the step, which keeps the energy of springs and "
           "orbits; with dt=0 as they are. Laws act on awake dynamic bodies; with wakes on sleeping ones "
           "too. An error of the law leaves the world as it was.")
      .def("apply_wrenches", &apply_rows, arg("wrenches"), py::kw_only(), arg("wakes") = false,
           "Adds the forces of the next step from an array (n, 3) with a row of each body, by its index: x, "
           "y (N) and torque (N m).")
      .def(
          "apply_linear_drag",
          [](const WorldPointer& h, double linear, double angular, double dt, Flag wakes) {
            apply(h, wakes, [&](auto& w, LawOptions o) {
              plumb::apply_linear_drag(w, {linear, angular}, dt, o);
            });
          },
          arg("linear"), arg("angular") = 0.0, py::kw_only(), arg("dt") = 1.0 / 60, arg("wakes") = false,
          "Adds F = -linear v and torque = -angular w, N s/m and N m s.")
      .def(
          "apply_quadratic_drag",
          [](const WorldPointer& h, double coefficient, double dt, Flag wakes) {
            apply(h, wakes,
                  [&](auto& w, LawOptions o) { plumb::apply_quadratic_drag(w, coefficient, dt, o); });
          },
          arg("coefficient"), py::kw_only(), arg("dt") = 1.0 / 60, arg("wakes") = false,
          "Adds F = -coefficient |v| v, N s^2/m^2.")
      .def(
          "apply_attraction",
          [](const WorldPointer& h, const std::variant<HeldBody, Vec2d>& centre, double strength,
             const std::string& falloff, double softening, double dt, Flag wakes) {
            const Attraction law{strength, named<Attraction::Falloff>(kFalloffs, falloff, "falloff"),
                                 softening};
            apply(h, wakes, [&](auto& w, LawOptions o) {
              if (const auto* body = std::get_if<HeldBody>(&centre))
                return plumb::apply_attraction_to_body(w, id_in(h, *body, "centre"), law, dt, o);
              plumb::apply_attraction(w, std::get<Vec2d>(centre), law, dt, o);
            });
          },
          arg("centre"), arg("strength"), py::kw_only(), arg("falloff") = "inverse_square",
          arg("softening") = Attraction{}.softening, arg("dt") = 1.0 / 60, arg("wakes") = false,
          "Attracts to a point (m) or a body: strength / r^2 (m^3/s^2) or strength r (1/s^2) for each kg.")
      .def(
          "apply_wind",
          [](const WorldPointer& h, Vec2d velocity, double density, double dt, Flag wakes) {
            apply(h, wakes, [&](auto& w, LawOptions o) { plumb::apply_wind(w, {velocity, density}, dt, o); });
          },
          arg("velocity"), py::kw_only(), arg("density") = Wind{}.density, arg("dt") = 1.0 / 60,
          arg("wakes") = false, "Presses on the outlines of shapes: m/s and kg/m^2 of the air.")
      .def(
          "apply_water",
          [](const WorldPointer& h, double level, double density, Vec2d velocity, double linear_drag,
             double angular_drag, double dt, Flag wakes) {
            apply(h, wakes, [&](auto& w, LawOptions o) {
              plumb::apply_water(w, {level, density, velocity, linear_drag, angular_drag}, dt, o);
            });
          },
          arg("level"), py::kw_only(), arg("density") = Water{}.density, arg("velocity") = Vec2d{},
          arg("linear_drag") = 0.0, arg("angular_drag") = 0.0, arg("dt") = 1.0 / 60, arg("wakes") = false,
          "Water below `level` (m, along up): kg/m^2, m/s, and drag in N s/m and N m s for each m^2 under "
          "water.")
      .def(
          "apply_spring",
          [](const WorldPointer& h, const HeldBody& a, Vec2d point_a, const HeldBody& b, Vec2d point_b,
             double stiffness, double damping, double rest_length, Flag pulls_only, double dt, Flag wakes) {
            apply(h, wakes, [&](auto& w, LawOptions o) {
              plumb::apply_spring(w, id_in(h, a, "a"), point_a, id_in(h, b, "b"), point_b,
                                  {stiffness, damping, rest_length, pulls_only}, dt, o);
            });
          },
          arg("a"), arg("point_a"), arg("b"), arg("point_b"), py::kw_only(),
          arg("stiffness") = ElasticSpring{}.stiffness, arg("damping") = 0.0,
          arg("rest_length") = ElasticSpring{}.rest_length, arg("pulls_only") = false, arg("dt") = 1.0 / 60,
          arg("wakes") = false,
          "Pulls between points of two bodies, in the bodies' frames (m): N/m, N s/m, m.")
      .def(
          "explode",
          [](const WorldPointer& h, Vec2d centre, double radius, double impulse, Flag occlusion,
             const std::optional<HeldBody>& ignore, std::uint64_t category, std::uint64_t mask, Flag sensors,
             const std::optional<py::function>& condition) {
            const Considered cover(h, ignore, category, mask, sensors, condition);
            h->visit([&](auto& w) {
              plumb::explode(w, {centre, radius, impulse}, {occlusion, cover.filter()});
            });
          },
          arg("centre"), py::kw_only(), arg("radius") = Blast{}.radius, arg("impulse") = Blast{}.impulse,
          arg("occlusion") = false, arg("ignore") = py::none(), arg("category") = QueryFilter{}.category,
          arg("mask") = QueryFilter{}.mask, arg("sensors") = false, arg("condition") = py::none(),
          "Pushes all dynamic bodies within `radius` (m) at once: N s for each m of surface square to it, "
          "at the centre. With occlusion it spares what another shape hides; the rest says which can.");
}

}  // namespace plumb::python
