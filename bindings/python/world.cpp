#include "engine/world/world.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "bindings/python/arrays.h"
#include "bindings/python/held_world.h"
#include "engine/driver/accuracy.h"
#include "engine/scene/json.h"
#include "engine/world/add_scene.h"
#include "engine/world/mover.h"
#include "engine/world/queries.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"

namespace plumb::python {
namespace {

using py::arg;
using Shapes = std::variant<std::monostate, ShapeDefinition, ShapeGeometry,
                            std::vector<std::variant<ShapeDefinition, ShapeGeometry>>>;

ShapeDefinition definition_of(const std::variant<ShapeDefinition, ShapeGeometry>& given) {
  if (const auto* whole = std::get_if<ShapeDefinition>(&given)) return *whole;
  ShapeDefinition shape;
  shape.geometry = std::get<ShapeGeometry>(given);
  return shape;
}

std::vector<ShapeDefinition> definitions_of(const Shapes& shapes) {
  std::vector<ShapeDefinition> all;
  if (const auto* one = std::get_if<ShapeDefinition>(&shapes)) all.push_back(*one);
  if (const auto* one = std::get_if<ShapeGeometry>(&shapes)) all.push_back(definition_of(*one));
  if (const auto* many = std::get_if<3>(&shapes)) {
    for (const auto& shape : *many) all.push_back(definition_of(shape));
  }
  return all;
}

std::string scene_text(const py::object& scene) {
  if (py::isinstance<py::str>(scene)) return scene.cast<std::string>();
  return py::module_::import("json").attr("dumps")(scene).cast<std::string>();
}

/// Returns the object that keeps viewed memory alive: one for all arrays that are there at a time.
py::object base_of(HeldWorld& held) {
  struct Base {
    std::shared_ptr<ViewedMemory> memory;
    WorldPointer world;
  };
  if (const std::shared_ptr<ViewedMemory> memory = held.viewed.lock())
    return py::reinterpret_borrow<py::object>(static_cast<PyObject*>(memory->base));
  const auto memory = std::make_shared<ViewedMemory>();
  py::object base = py::capsule(new Base{memory, held.shared_from_this()},
                                [](void* pointer) { delete static_cast<Base*>(pointer); });
  memory->base = base.ptr();
  held.viewed = memory;
  return base;
}

/// Returns an array that views `count` items of `width` numbers at `first`, `stride` bytes apart.
template <class Number>
py::array view(HeldWorld& held, const Number* first, std::size_t count, std::size_t stride, int width) {
  static const Number kNothing[2] = {};
  const auto items = static_cast<py::ssize_t>(count), apart = static_cast<py::ssize_t>(stride);
  const py::array::ShapeContainer shape =
      width > 1 ? py::array::ShapeContainer{items, py::ssize_t{width}} : py::array::ShapeContainer{items};
  const py::array::StridesContainer strides =
      width > 1 ? py::array::StridesContainer{apart, static_cast<py::ssize_t>(sizeof(Number))}
                : py::array::StridesContainer{apart};
  py::array array(py::dtype::of<Number>(), shape, strides, first != nullptr ? first : kNothing,
                  base_of(held));
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// A contact as numpy has it.
struct ContactRow {
  std::uint32_t body_a, body_b;
  std::uint32_t shape_a, shape_b;
  std::int32_t count;
  std::int32_t unused;
  double normal[2];
  double points[2][2];
  double separations[2];
  double impulses[2];
};

py::array_t<ContactRow> contacts_of(HeldWorld& held) {
  std::vector<ContactRow> all;
  held.visit([&](auto& w) {
    std::vector<ContactReading> readings(w.contacts(std::span<ContactReading>{}));
    w.contacts(readings);
    for (const ContactReading& c : readings) {
      ContactRow row{w.body(c.shape_a).index,
                     w.body(c.shape_b).index,
                     c.shape_a.index,
                     c.shape_b.index,
                     c.count,
                     0,
                     {c.normal.x, c.normal.y},
                     {},
                     {},
                     {}};
      for (int i = 0; i < c.count; ++i) {
        row.points[i][0] = c.points[i].x, row.points[i][1] = c.points[i].y;
        row.separations[i] = c.separations[i], row.impulses[i] = c.impulses[i];
      }
      all.push_back(row);
    }
  });
  py::array_t<ContactRow> out(static_cast<py::ssize_t>(all.size()));
  if (!all.empty()) std::memcpy(out.mutable_data(), all.data(), all.size() * sizeof(ContactRow));
  return out;
}

template <class Id>
py::list handles(const WorldPointer& world, const std::vector<Id>& ids) {
  py::list all;
  for (const Id id : ids) all.append(Held<Id>{world, id});
  return all;
}

py::dict events_of(const WorldPointer& held) {
  return held->visit([&](auto& w) {
    const Events& e = w.events();
    const auto shape = [&](ShapeId id) { return HeldShape{held, id}; };
    const auto body = [&](BodyId id) { return HeldBody{held, id}; };
    const auto touches = [&](const std::vector<TouchEvent>& all) {
      py::list list;
      for (const TouchEvent& t : all) list.append(py::make_tuple(shape(t.shape_a), shape(t.shape_b)));
      return list;
    };
    const auto sensed = [&](const std::vector<SensorEvent>& all) {
      py::list list;
      for (const SensorEvent& s : all) list.append(py::make_tuple(shape(s.sensor), shape(s.visitor)));
      return list;
    };
    py::list hits, quarantined;
    for (const HitEvent& h : e.hits) {
      hits.append(py::dict(arg("shape_a") = shape(h.shape_a), arg("shape_b") = shape(h.shape_b),
                           arg("point") = h.point, arg("normal") = h.normal, arg("speed") = h.speed));
    }
    std::vector<JointId> broken;
    for (const JointEvent& j : e.broken) broken.push_back(j.joint);
    for (const QuarantineEvent& q : e.quarantined) {
      quarantined.append(py::dict(arg("body") = body(q.body),
                                  arg("field") = kBadFieldNames[static_cast<int>(q.field)],
                                  arg("value") = q.value, arg("step") = q.step));
    }
    return py::dict(arg("begin") = touches(e.begin), arg("end") = touches(e.end), arg("hits") = hits,
                    arg("sensor_begin") = sensed(e.sensor_begin), arg("sensor_end") = sensed(e.sensor_end),
                    arg("broken") = handles(held, broken), arg("fell_asleep") = handles(held, e.fell_asleep),
                    arg("woke") = handles(held, e.woke), arg("quarantined") = quarantined);
  });
}

py::dict reading_of(const WorldPointer& held, const ContactReading& c) {
  py::list points, separations, impulses;
  for (int i = 0; i < c.count; ++i)
    points.append(c.points[i]), separations.append(c.separations[i]), impulses.append(c.impulses[i]);
  return py::dict(arg("shape_a") = HeldShape{held, c.shape_a}, arg("shape_b") = HeldShape{held, c.shape_b},
                  arg("normal") = c.normal, arg("points") = points, arg("separations") = separations,
                  arg("impulses") = impulses, arg("approach") = c.approach);
}

/// A filter of a query; `ignore` is a body or None.
QueryFilter filter_of(const std::optional<HeldBody>& ignore, std::uint32_t category, std::uint32_t mask,
                      bool sensors) {
  QueryFilter filter;
  filter.category = category, filter.mask = mask, filter.sensors = sensors;
  if (ignore) filter.ignore = ignore->id;
  return filter;
}

py::dict hit_of(const WorldPointer& held, const auto& hit) {
  return py::dict(arg("shape") = HeldShape{held, hit.shape}, arg("body") = HeldBody{held, hit.body},
                  arg("point") = hit.point, arg("normal") = hit.normal);
}

WorldPointer make_world(Vec2d gravity, const std::string& precision, const std::string& solver,
                        const std::string& integrator, int iterations, bool sleeping, bool continuous,
                        bool direct_islands, bool quarantine, const std::string& friction,
                        const std::string& restitution) {
  WorldDefinition d;
  d.gravity = gravity;
  d.solver = named<Solver>(kSolvers, solver, "solver");
  d.integrator = named<Integrator>(kIntegrators, integrator, "integrator");
  d.iterations = iterations;
  d.sleeping = sleeping, d.continuous = continuous;
  d.direct_islands = direct_islands, d.quarantine = quarantine;
  d.combine_friction = named<Combine>(kCombines, friction, "combine_friction");
  d.combine_restitution = named<Combine>(kCombines, restitution, "combine_restitution");
  if (named<Precision>(kPrecisions, precision, "precision") == Precision::Float)
    return std::make_shared<HeldWorld>(World(d));
  return std::make_shared<HeldWorld>(DoubleWorld(d));
}

void bind_handles(py::module_& module) {
  // Calls of the world by way of a handle.
#define PLUMB_READ(Type, expression) \
  [](const Type& h) { return h.world->visit([&]([[maybe_unused]] auto& w) { return expression; }); }
#define PLUMB_SET(Type, Value, call) \
  [](const Type& h, Value value) { h.world->visit([&](auto& w) { call; }); }

  py::class_<HeldBody> body(module, "Body", "A body of a world: SI units, angles in rad.");
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
                    PLUMB_SET(HeldBody, double, w.set_gravity_scale(h.id, value)))
      .def_property("linear_damping", PLUMB_READ(HeldBody, w.linear_damping(h.id)),
                    PLUMB_SET(HeldBody, double, w.set_damping(h.id, value, w.angular_damping(h.id))), "1/s")
      .def_property("angular_damping", PLUMB_READ(HeldBody, w.angular_damping(h.id)),
                    PLUMB_SET(HeldBody, double, w.set_damping(h.id, w.linear_damping(h.id), value)), "1/s")
      .def_property("awake", PLUMB_READ(HeldBody, w.awake(h.id)),
                    PLUMB_SET(HeldBody, bool, w.set_awake(h.id, value)))
      .def_property("may_sleep", PLUMB_READ(HeldBody, w.may_sleep(h.id)),
                    PLUMB_SET(HeldBody, bool, w.set_may_sleep(h.id, value)))
      .def_property("user_data", PLUMB_READ(HeldBody, w.user_data(h.id)),
                    PLUMB_SET(HeldBody, std::uint64_t, w.set_user_data(h.id, value)))
      .def_property("enabled", PLUMB_READ(HeldBody, w.enabled(h.id)),
                    PLUMB_SET(HeldBody, bool, w.set_enabled(h.id, value)),
                    "False takes the body out of the simulation until it is set again.")
      .def_property_readonly(
          "box",
          [](const HeldBody& h) {
            const Aabb<double> box = h.world->visit([&](auto& w) { return w.box(h.id); });
            return py::make_tuple(box.lower, box.upper);
          },
          "lower and upper corner of the box around its shapes, m")
      .def_property("name", PLUMB_READ(HeldBody, std::string(w.name(h.id))),
                    PLUMB_SET(HeldBody, const std::string&, w.set_name(h.id, value)))
      .def_property_readonly("valid", PLUMB_READ(HeldBody, w.valid(h.id)))
      .def_property_readonly("quarantined", PLUMB_READ(HeldBody, w.quarantined(h.id)))
      .def_property_readonly("shapes", PLUMB_READ(HeldBody, handles(h.world, w.shapes(h.id))))
      .def_property_readonly("joints", PLUMB_READ(HeldBody, handles(h.world, w.joints(h.id))))
      .def(
          "contacts",
          [](const HeldBody& h) {
            return h.world->visit([&](auto& w) {
              py::list all;
              for (const ContactReading& c : w.contacts(h.id)) all.append(reading_of(h.world, c));
              return all;
            });
          },
          "Contacts with points, as dicts; impulses in N s, of the last substep.")
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
          [](const HeldBody& h, bool x, bool y, bool rotation) {
            h.world->visit([&](auto& w) { w.set_locks(h.id, x, y, rotation); });
          },
          arg("x") = false, arg("y") = false, arg("rotation") = false)
      .def(
          "world_point",
          [](const HeldBody& h, Vec2d local) {
            return h.world->visit([&](auto& w) { return w.world_point(h.id, local); });
          },
          arg("local"), "m, in the world, of a point in the body's frame.")
      .def(
          "create_shape",
          [](const HeldBody& h, const std::variant<ShapeDefinition, ShapeGeometry>& shape) {
            const ShapeDefinition d = definition_of(shape);
            return HeldShape{h.world, h.world->visit([&](auto& w) { return w.create_shape(h.id, d); })};
          },
          arg("shape"), "Adds a shape: a geometry or a ShapeDefinition.")
      .def(
          "create_chain",
          [](const HeldBody& h, std::vector<Vec2d> points, bool closed, double friction, double restitution) {
            ChainDefinition d;
            d.points = std::move(points), d.closed = closed;
            d.material.friction = friction, d.material.restitution = restitution;
            return HeldChain{h.world, h.world->visit([&](auto& w) { return w.create_chain(h.id, d); })};
          },
          arg("points"), arg("closed") = false, py::kw_only(), arg("friction") = Material{}.friction,
          arg("restitution") = 0.0,
          "Adds a line of one-sided segments through points, m; the front is to the right when walking along "
          "it.")
      .def(
          "release", [](const HeldBody& h) { h.world->visit([&](auto& w) { w.release(h.id); }); },
          "Releases it from quarantine.")
      .def(
          "destroy", [](const HeldBody& h) { h.world->visit([&](auto& w) { w.destroy(h.id); }); },
          "Destroys it with its shapes, contacts and joints.");

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

  py::class_<HeldChain> chain(module, "Chain", "A chain of segments of a body.");
  chain.def_property_readonly("valid", PLUMB_READ(HeldChain, w.valid(h.id)))
      .def_property_readonly("segments", PLUMB_READ(HeldChain, handles(h.world, w.segments(h.id))))
      .def("destroy", [](const HeldChain& h) { h.world->visit([&](auto& w) { w.destroy(h.id); }); });

  py::class_<HeldJoint> joint(module, "Joint", "A joint of two bodies.");
  joint.def_property_readonly("valid", PLUMB_READ(HeldJoint, w.valid(h.id)))
      .def_property_readonly("kind", PLUMB_READ(HeldJoint, JointKind(w.kind(h.id))))
      .def_property_readonly("bodies",
                             [](const HeldJoint& h) {
                               const auto [a, b] = h.world->visit([&](auto& w) { return w.bodies(h.id); });
                               return py::make_tuple(HeldBody{h.world, a}, HeldBody{h.world, b});
                             })
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
      .def("destroy", [](const HeldJoint& h) { h.world->visit([&](auto& w) { w.destroy(h.id); }); });

  const auto common = [](auto& type, const char* name) {
    using Handle = typename std::remove_reference_t<decltype(type)>::type;
    type.def_property_readonly(
            "index", [](const Handle& h) { return h.id.index; }, "Its row in the world's arrays.")
        .def(
            "__eq__", [](const Handle& a, const Handle& b) { return a == b; }, py::is_operator())
        .def("__hash__",
             [](const Handle& h) {
               return std::hash<std::uint64_t>{}(std::uint64_t{h.id.generation} << 32 | h.id.index);
             })
        .def("__repr__", [name](const Handle& h) {
          return "<plumb." + std::string(name) + " " + std::to_string(h.id.index) + ">";
        });
  };
  common(body, "Body"), common(shape, "Shape"), common(chain, "Chain"), common(joint, "Joint");
}

}  // namespace

void bind_world(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(ContactRow, body_a, body_b, shape_a, shape_b, count, normal, points, separations,
                       impulses);
  bind_handles(module);
  const WorldDefinition d;
  py::class_<HeldWorld, WorldPointer>(
      module, "World",
      "A world of bodies, shapes and joints that advances in fixed steps. SI units, y up, angles in rad.\n\n"
      "Arrays of all bodies have a row for each index of a body (`Body.index`). `centres`, `angles`, "
      "`velocities` and "
      "`angular_velocities` are views without a copy: they show each step as it is taken. Take them anew "
      "after "
      "bodies were created, or a snapshot restored: older ones no longer follow the world.")
      .def(py::init(&make_world), py::kw_only(), arg("gravity") = d.gravity, arg("precision") = "float",
           arg("solver") = "soft_steps", arg("integrator") = "velocity_verlet",
           arg("iterations") = d.iterations, arg("sleeping") = true, arg("continuous") = true,
           arg("direct_islands") = true, arg("quarantine") = true, arg("combine_friction") = "geometric_mean",
           arg("combine_restitution") = "maximum",
           "gravity: m/s^2; precision: 'float' or 'double', of the solver.")
      .def(
          "step",
          [](HeldWorld& h, double dt, int substeps, int count) {
            h.visit([&](auto& w) {
              const py::gil_scoped_release released;
              for (int i = 0; i < count; ++i) w.step(dt, substeps);
            });
          },
          arg("dt") = 1.0 / 60, arg("substeps") = 4, arg("count") = 1,
          "Advances `count` steps of dt, s, each in substeps.")
      .def_property_readonly(
          "time", [](HeldWorld& h) { return h.visit([](auto& w) { return w.time(); }); }, "s")
      .def_property_readonly("step_count",
                             [](HeldWorld& h) { return h.visit([](auto& w) { return w.step_count(); }); })
      .def_property(
          "gravity", [](HeldWorld& h) { return h.visit([](auto& w) { return w.gravity(); }); },
          [](HeldWorld& h, Vec2d g) { h.visit([&](auto& w) { w.set_gravity(g); }); }, "m/s^2")
      .def_property(
          "solver",
          [](HeldWorld& h) { return h.visit([](auto& w) { return name_in(kSolvers, w.solver()); }); },
          [](HeldWorld& h, const std::string& name) {
            const auto solver = named<Solver>(kSolvers, name, "solver");
            h.visit([&](auto& w) { w.set_solver(solver); });
          })
      .def_property_readonly("precision", [](HeldWorld& h) { return kPrecisions[h.world.index()]; })
      .def(
          "set_sleeping", [](HeldWorld& h, bool on) { h.visit([&](auto& w) { w.set_sleeping(on); }); },
          arg("on"))
      .def(
          "set_continuous", [](HeldWorld& h, bool on) { h.visit([&](auto& w) { w.set_continuous(on); }); },
          arg("on"))
      .def(
          "set_profiling", [](HeldWorld& h, bool on) { h.visit([&](auto& w) { w.set_profiling(on); }); },
          arg("on"))
      .def_property_readonly(
          "profile",
          [](HeldWorld& h) {
            return h.visit([](auto& w) {
              py::dict stages(arg("steps") = w.profile().steps);
              for (std::size_t i = 0; i < kWorldStages; ++i)
                stages[kWorldStageNames[i]] = w.profile().nanoseconds[i];
              return stages;
            });
          },
          "ns of each stage since profiling was switched on, and the steps")
      .def_property_readonly("counts",
                             [](HeldWorld& h) {
                               const WorldCounts c = h.visit([](auto& w) { return w.counts(); });
                               return py::dict(arg("bodies") = c.bodies, arg("awake") = c.awake,
                                               arg("shapes") = c.shapes, arg("contacts") = c.contacts,
                                               arg("touching") = c.touching, arg("joints") = c.joints);
                             })
      .def(
          "create_body",
          [](const WorldPointer& h, const Shapes& shapes, const std::string& type, Vec2d position,
             double angle, Vec2d velocity, double angular_velocity, const std::string& name,
             std::optional<std::tuple<double, double, Vec2d>> mass, double gravity_scale,
             double linear_damping, double angular_damping, bool lock_x, bool lock_y, bool lock_rotation,
             bool may_sleep, bool awake, std::uint64_t user_data) {
            BodyDefinition b;
            b.name = name, b.type = named<BodyType>(kBodyTypes, type, "type");
            b.position = position, b.angle = angle, b.velocity = velocity,
            b.angular_velocity = angular_velocity;
            if (mass) b.mass = MassProperties{std::get<0>(*mass), std::get<2>(*mass), std::get<1>(*mass)};
            b.gravity_scale = gravity_scale, b.linear_damping = linear_damping,
            b.angular_damping = angular_damping;
            b.lock_x = lock_x, b.lock_y = lock_y, b.lock_rotation = lock_rotation;
            b.may_sleep = may_sleep, b.awake = awake, b.user_data = user_data;
            const std::vector<ShapeDefinition> all = definitions_of(shapes);
            h->leave_views_if_full();
            return HeldBody{h, h->visit([&](auto& w) { return w.create_body(b, all); })};
          },
          arg("shapes") = py::none(), py::kw_only(), arg("type") = "dynamic", arg("position") = Vec2d{},
          arg("angle") = 0.0, arg("velocity") = Vec2d{}, arg("angular_velocity") = 0.0, arg("name") = "",
          arg("mass") = py::none(), arg("gravity_scale") = 1.0, arg("linear_damping") = 0.0,
          arg("angular_damping") = 0.0, arg("lock_x") = false, arg("lock_y") = false,
          arg("lock_rotation") = false, arg("may_sleep") = true, arg("awake") = true, arg("user_data") = 0,
          "Creates a body. shapes: a geometry, a ShapeDefinition or a list of these; position: m; angle: "
          "rad; velocity: "
          "m/s; mass: (kg, kg m^2, centre in m), else densities count; damping: 1/s.")
      .def(
          "create_joint",
          [](const WorldPointer& h, const HeldBody& a, const HeldBody& b, const JointKind& kind, bool collide,
             double break_force, double break_torque, std::uint64_t user_data) {
            return HeldJoint{
                h, h->visit([&](auto& w) {
                  return w.create_joint(a.id, b.id, {kind, collide, break_force, break_torque, user_data});
                })};
          },
          arg("a"), arg("b"), arg("kind"), py::kw_only(), arg("collide") = false, arg("break_force") = 0.0,
          arg("break_torque") = 0.0, arg("user_data") = 0,
          "Joins two bodies; break_force: N, break_torque: N m, 0: never.")
      .def(
          "add_scene",
          [](const WorldPointer& h, const py::object& scene) {
            const Scene read = scene_from_json(scene_text(scene));
            h->leave_views();
            const SceneParts parts = h->visit([&](auto& w) { return add_scene(w, read); });
            py::dict bodies;
            for (std::size_t i = 0; i < parts.bodies.size(); ++i)
              bodies[py::str(read.bodies[i].name)] = HeldBody{h, parts.bodies[i]};
            return bodies;
          },
          arg("scene"), "Adds the bodies and joints of a scene, a dict or JSON; returns the bodies by name.")
      .def_property_readonly(
          "bodies",
          [](const WorldPointer& h) { return h->visit([&](auto& w) { return handles(h, w.bodies()); }); },
          "All bodies, by index.")
      .def_property_readonly("events", &events_of,
                             "Of the last step: begin, end, hits, sensor_begin, sensor_end, broken, "
                             "fell_asleep, woke, quarantined.")

      .def_property_readonly(
          "centres",
          [](HeldWorld& h) {
            return h.visit([&](auto& w) {
              const auto& all = w.data().position;
              return view(h, all.empty() ? static_cast<const double*>(nullptr) : &all[0].x, all.size(),
                          sizeof(Vec2d), 2);
            });
          },
          "m, centres of mass; a view, (n, 2)")
      .def_property_readonly(
          "angles",
          [](HeldWorld& h) {
            return h.visit([&]<class Real>(BasicWorld<Real>& w) {
              auto& all = std::get<0>(w.data().bodies.parts());
              return view(h, all.empty() ? static_cast<const double*>(nullptr) : &all[0].angle, all.size(),
                          sizeof(BodyRecord<Real>), 1);
            });
          },
          "rad; a view, (n,)")
      .def_property_readonly(
          "velocities",
          [](HeldWorld& h) {
            return h.visit([&]<class Real>(BasicWorld<Real>& w) {
              const auto& all = w.data().motion;
              return view(h, all.empty() ? static_cast<const Real*>(nullptr) : &all[0].velocity.x, all.size(),
                          sizeof(BodyMotion<Real>), 2);
            });
          },
          "m/s, of the centres of mass; a view, (n, 2), in the world's precision")
      .def_property_readonly(
          "angular_velocities",
          [](HeldWorld& h) {
            return h.visit([&]<class Real>(BasicWorld<Real>& w) {
              const auto& all = w.data().motion;
              return view(h, all.empty() ? static_cast<const Real*>(nullptr) : &all[0].angular_velocity,
                          all.size(), sizeof(BodyMotion<Real>), 1);
            });
          },
          "rad/s; a view, (n,), in the world's precision")
      .def_property_readonly(
          "poses",
          [](HeldWorld& h) {
            return h.visit([](auto& w) {
              py::array_t<double> out({static_cast<py::ssize_t>(w.data().bodies.size()), py::ssize_t{3}});
              write_poses(w, out.mutable_data());
              return out;
            });
          },
          "x and y of the origins, m, and angles, rad; a copy, (n, 3); NaN for destroyed bodies")
      .def_property_readonly(
          "used",
          [](HeldWorld& h) {
            return h.visit([](auto& w) {
              const auto& bodies = w.data().bodies;
              py::array_t<bool> used(bodies.size());
              for (int i = 0; i < bodies.size(); ++i) used.mutable_data()[i] = bodies.used(i);
              return used;
            });
          },
          "False for rows of destroyed bodies; a copy, (n,)")
      .def_property_readonly("contacts", &contacts_of,
                             "All contacts with points: body_a, body_b, shape_a, shape_b (indices), count, "
                             "normal, points (m), separations "
                             "(m), impulses (N s, of the last substep); a structured array, a copy")
      .def(
          "apply_forces",
          [](HeldWorld& h, const py::array_t<double, py::array::c_style | py::array::forcecast>& forces) {
            h.visit([&](auto& w) {
              const auto& bodies = w.data().bodies;
              if (forces.ndim() != 2 || forces.shape(0) != bodies.size() ||
                  (forces.shape(1) != 2 && forces.shape(1) != 3)) {
                throw Error(Error::Kind::Value, "world", "forces", "an array of another shape",
                            "must have a row for each of the " + std::to_string(bodies.size()) +
                                " body indices, of 2 or 3 numbers");
              }
              const auto width = forces.shape(1);
              const double* row = forces.data();
              for (int body = 0; body < bodies.size(); ++body, row += width) {
                const double torque = width == 3 ? row[2] : 0;
                if (!bodies.used(body) || (row[0] == 0 && row[1] == 0 && torque == 0)) continue;
                const BodyId id{static_cast<std::uint32_t>(body), bodies.generation(body)};
                w.apply_force(id, Vec2d{row[0], row[1]});
                if (torque != 0) w.apply_torque(id, torque);
              }
            });
          },
          arg("forces"),
          "Applies a force (N) to each body during the next step: (n, 2), or (n, 3) with torques (N m).")

      .def(
          "hash", [](HeldWorld& h) { return h.visit([](auto& w) { return w.hash(); }); },
          "Hash of all bodies' states: equal on every platform and in every language.")
      .def(
          "full_hash", [](HeldWorld& h) { return h.visit([](auto& w) { return full_hash(w); }); },
          "Hash of all that the future depends on.")
      .def(
          "save",
          [](HeldWorld& h) {
            const std::vector<std::byte> bytes = h.visit([](auto& w) { return save(w); });
            return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
          },
          "All that the future depends on, as bytes.")
      .def(
          "restore",
          [](HeldWorld& h, const py::bytes& bytes) {
            const std::string_view text = bytes;
            h.leave_views();
            h.visit([&](auto& w) { restore(w, std::as_bytes(std::span(text.data(), text.size()))); });
          },
          arg("bytes"), "Goes back to a saved state; the world is unchanged if the bytes are refused.")
      .def(
          "on_pre_solve",
          [](HeldWorld& h, std::optional<std::function<bool(py::dict)>> hook) {
            const std::weak_ptr<HeldWorld> world = h.weak_from_this();
            h.visit([&](auto& w) {
              if (!hook) return w.on_pre_solve({});
              w.on_pre_solve([hook = *hook, world](const ContactReading& c) {
                const py::gil_scoped_acquire held;
                return hook(reading_of(world.lock(), c));
              });
            });
          },
          arg("hook"),
          "Calls hook(contact) for contacts of shapes with pre_solve; False disables one in this step.")

      .def(
          "ray_cast",
          [](const WorldPointer& h, Vec2d origin, Vec2d translation, std::optional<HeldBody> ignore,
             std::uint32_t category, std::uint32_t mask, bool sensors) -> py::object {
            const auto hit = h->visit([&](auto& w) {
              return ray_cast_closest(w, origin, translation, filter_of(ignore, category, mask, sensors));
            });
            if (!hit) return py::none();
            py::dict found = hit_of(h, *hit);
            found["fraction"] = hit->fraction;
            return found;
          },
          arg("origin"), arg("translation"), py::kw_only(), arg("ignore") = py::none(),
          arg("category") = 0xFFFFFFFFu, arg("mask") = 0xFFFFFFFFu, arg("sensors") = false,
          "The closest hit of a ray (m) as a dict of shape, body, point, normal and fraction, or None.")
      .def(
          "ray_cast_all",
          [](const WorldPointer& h, Vec2d origin, Vec2d translation) {
            std::vector<RayResult> hits;
            h->visit([&](auto& w) { ray_cast_all(w, origin, translation, {}, hits); });
            py::list all;
            for (const RayResult& hit : hits) {
              py::dict found = hit_of(h, hit);
              found["fraction"] = hit.fraction;
              all.append(found);
            }
            return all;
          },
          arg("origin"), arg("translation"), "All hits of a ray, by fraction.")
      .def(
          "ray_casts",
          [](HeldWorld& h, const py::array_t<double, py::array::c_style | py::array::forcecast>& rays) {
            if (rays.ndim() != 2 || rays.shape(1) != 4)
              throw Error(Error::Kind::Value, "rays", "shape", "another one",
                          "must be (n, 4): origin and translation, m");
            py::array_t<double> fractions(rays.shape(0));
            h.visit([&](auto& w) {
              for (py::ssize_t i = 0; i < rays.shape(0); ++i) {
                const double* ray = rays.data(i, 0);
                const auto hit = ray_cast_closest(w, {ray[0], ray[1]}, {ray[2], ray[3]});
                *fractions.mutable_data(i) = hit ? hit->fraction : 1;
              }
            });
            return fractions;
          },
          arg("rays"),
          "Fractions at which rays hit, 1 for none: rays is (n, 4), origins and translations, m.")
      .def(
          "cast_shape",
          [](const WorldPointer& h, const ShapeGeometry& shape, Vec2d position, double angle,
             Vec2d translation, std::optional<HeldBody> ignore) -> py::object {
            const auto hit = h->visit([&](auto& w) {
              return cast_shape_closest(w, QueryShape(shape), position, angle, translation,
                                        filter_of(ignore, ~0u, ~0u, false));
            });
            if (!hit) return py::none();
            py::dict found = hit_of(h, *hit);
            found["fraction"] = hit->fraction, found["overlapped"] = hit->overlapped;
            return found;
          },
          arg("shape"), arg("position"), arg("angle"), arg("translation"), py::kw_only(),
          arg("ignore") = py::none(), "First contact of a shape that moves by `translation`, m, or None.")
      .def(
          "overlap_shape",
          [](const WorldPointer& h, const ShapeGeometry& shape, Vec2d position, double angle) {
            std::vector<ShapeId> found;
            h->visit([&](auto& w) { overlap_shape(w, QueryShape(shape), position, angle, {}, found); });
            return handles(h, found);
          },
          arg("shape"), arg("position"), arg("angle") = 0.0)
      .def(
          "overlap_box",
          [](const WorldPointer& h, Vec2d lower, Vec2d upper) {
            std::vector<ShapeId> found;
            h->visit([&](auto& w) { overlap_box(w, Aabb<double>{lower, upper}, {}, found); });
            return handles(h, found);
          },
          arg("lower"), arg("upper"))
      .def(
          "shapes_at",
          [](const WorldPointer& h, Vec2d point) {
            std::vector<ShapeId> found;
            h->visit([&](auto& w) { shapes_at(w, point, {}, found); });
            return handles(h, found);
          },
          arg("point"))
      .def(
          "nearest",
          [](const WorldPointer& h, Vec2d point, double max_distance) -> py::object {
            const auto hit = h->visit([&](auto& w) { return nearest(w, point, max_distance); });
            if (!hit) return py::none();
            py::dict found = hit_of(h, *hit);
            found["distance"] = hit->distance;
            return found;
          },
          arg("point"), arg("max_distance"),
          "The shape whose surface is nearest, within max_distance, m, or None.")
      .def(
          "move",
          [](const WorldPointer& h, const Capsule& capsule, Vec2d position, Vec2d velocity, double dt,
             Vec2d up, double max_slope, double step_height, double skin, double mass, double push_force,
             bool push) {
            const MoverOptions o{up, max_slope, step_height, skin, mass, push_force, {}};
            return h->visit([&](auto& w) {
              const MoverResult r = move(w, capsule, position, velocity, dt, o);
              if (push) apply_pushes(w, r);
              return py::dict(arg("position") = r.position, arg("velocity") = r.velocity,
                              arg("on_ground") = r.on_ground, arg("squeezed") = r.squeezed,
                              arg("ground_normal") = r.ground_normal, arg("ground") = HeldBody{h, r.ground},
                              arg("ground_velocity") = r.ground_velocity);
            });
          },
          arg("capsule"), arg("position"), arg("velocity"), arg("dt"), py::kw_only(), arg("up") = Vec2d{0, 1},
          arg("max_slope") = MoverOptions{}.max_slope, arg("step_height") = MoverOptions{}.step_height,
          arg("skin") = 0.0, arg("mass") = 0.0, arg("push_force") = MoverOptions{}.push_force,
          arg("push") = true,
          "Moves a character, a capsule, by its velocity (m/s) for dt (s), stopped by bodies. Call it before "
          "the step.");
}

}  // namespace plumb::python
