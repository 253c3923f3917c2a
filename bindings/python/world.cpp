#include "engine/world/world.h"

#include <memory>
#include <optional>

#include "bindings/python/handles.h"
#include "bindings/python/interrupt.h"
#include "engine/driver/accuracy.h"
#include "engine/scene/json.h"
#include "engine/world/add_scene.h"

namespace plumb::python {
namespace {

using py::arg;
constexpr const char* kTrueOrFalse = "True or False";
using Shapes = std::variant<std::monostate, ShapeDefinition, ShapeGeometry,
                            std::vector<std::variant<ShapeDefinition, ShapeGeometry>>>;

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
  return py::module_::import("plumb._json").attr("text")(scene).cast<std::string>();
}

py::dict fault_of(const WorldReference& world, const QuarantineEvent& q) {
  return py::dict(arg("body") = HeldBody{world, q.body},
                  arg("field") = kBadFieldNames[static_cast<int>(q.field)], arg("value") = q.value,
                  arg("step") = q.step);
}

// A setting of a world, and a call that changes it.
#define PLUMB_SETTING(name) \
  [](HeldWorld& h) { return h.visit([](auto& w) { return w.data().settings.name; }); }
#define PLUMB_CHANGE(Value, call) [](HeldWorld& h, Value value) { h.visit([&](auto& w) { w.call(value); }); }

py::dict events_of(const WorldPointer& held) {
  return held->visit([&](auto& w) {
    const Events& e = w.events();
    const WorldReference world = held;
    const auto shape = [&](ShapeId id) { return HeldShape{world, id}; };
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
                           arg("point") = h.point, arg("normal") = h.normal, arg("speed") = h.speed,
                           arg("impulse") = h.impulse));
    }
    std::vector<JointId> broken;
    for (const JointEvent& j : e.broken) broken.push_back(j.joint);
    py::list loaded;
    for (const JointLoadEvent& j : e.loaded) {
      loaded.append(py::dict(arg("joint") = HeldJoint{world, j.joint}, arg("force") = j.force,
                             arg("torque") = j.torque));
    }
    for (const QuarantineEvent& q : e.quarantined) {
      quarantined.append(fault_of(world, q));
    }
    return py::dict(arg("begin") = touches(e.begin), arg("end") = touches(e.end), arg("hits") = hits,
                    arg("sensor_begin") = sensed(e.sensor_begin), arg("sensor_end") = sensed(e.sensor_end),
                    arg("broken") = handles(world, broken), arg("loaded") = loaded,
                    arg("fell_asleep") = handles(world, e.fell_asleep), arg("woke") = handles(world, e.woke),
                    arg("quarantined") = quarantined);
  });
}

WorldPointer make_world(Vec2d gravity, const std::string& precision, const std::string& solver,
                        const std::string& integrator, int iterations, Flag sleeping, Flag continuous,
                        Flag direct_islands, Flag quarantine, const std::string& friction,
                        const std::string& restitution, int threads,
                        const std::array<double, 3>& thresholds) {
  WorldDefinition d;
  d.gravity = gravity;
  d.solver = named<Solver>(kSolvers, solver, "solver");
  d.integrator = named<Integrator>(kIntegrators, integrator, "integrator");
  d.iterations = iterations;
  d.sleeping = sleeping, d.continuous = continuous;
  d.direct_islands = direct_islands, d.quarantine = quarantine;
  d.combine_friction = named<Combine>(kCombines, friction, "combine_friction");
  d.combine_restitution = named<Combine>(kCombines, restitution, "combine_restitution");
  d.threads = threads;
  d.thresholds = {thresholds[0], thresholds[1], thresholds[2]};
  if (named<Precision>(kPrecisions, precision, "precision") == Precision::Float)
    return std::make_shared<HeldWorld>(World(d));
  return std::make_shared<HeldWorld>(DoubleWorld(d));
}

}  // namespace

void bind_world(py::module_& module) {
  bind_shapes(module), bind_bodies(module), bind_joints(module);
  const WorldDefinition d;
  HeldWorldClass bound(
      module, "World", collected<HeldWorld>(),
      "A world of bodies, shapes and joints that advances in fixed steps. SI units, y up, angles in rad.\n\n"
      "Arrays of all bodies have a row for each index of a body (`Body.index`). `centres`, `angles`, "
      "`velocities` and "
      "`angular_velocities` are views without a copy: they show each step as it is taken. Take them anew "
      "after "
      "bodies were created, or a snapshot restored: older ones no longer follow the world.");
  bound
      .def(py::init(&make_world), py::kw_only(), arg("gravity") = d.gravity, arg("precision") = "float",
           arg("solver") = "soft_steps", arg("integrator") = "velocity_verlet",
           arg("iterations") = d.iterations, arg("sleeping") = true, arg("continuous") = true,
           arg("direct_islands") = true, arg("quarantine") = true, arg("combine_friction") = "geometric_mean",
           arg("combine_restitution") = "maximum", arg("threads") = d.threads,
           arg("thresholds") = std::array<double, 3>{-1, -1, -1},
           "gravity: m/s^2; precision: 'float' or 'double', of the solver; threads: share a large step, with "
           "the same "
           "bits for every number; thresholds: (hit, bounce, sleep), m/s, negative: by the shapes' sizes.")
      .def(
          "step",
          [](HeldWorld& h, double dt, int substeps, int count) {
            require_count("step", "count", count, 0);
            h.visit([&](auto& w) {
              const py::gil_scoped_release released;
              InterruptCheck interrupted;
              for (int i = 0; i < count; ++i) w.step(dt, substeps), interrupted();
            });
          },
          arg("dt") = 1.0 / 60, arg("substeps") = 4, arg("count") = 1,
          "Advances `count` steps of dt, s, each in substeps.")
      .def_property_readonly(
          "time", [](HeldWorld& h) { return h.visit([](auto& w) { return w.time(); }); }, "s")
      .def_property_readonly(
          "step_count", [](HeldWorld& h) { return h.visit([](auto& w) { return w.step_count(); }); },
          "Steps taken so far.")
      .def_property(
          "gravity", [](HeldWorld& h) { return h.visit([](auto& w) { return w.gravity(); }); },
          [](HeldWorld& h, Vec2d g) { h.visit([&](auto& w) { w.set_gravity(g); }); }, "m/s^2")
      .def_property(
          "solver",
          [](HeldWorld& h) { return h.visit([](auto& w) { return name_in(kSolvers, w.solver()); }); },
          [](HeldWorld& h, const std::string& name) {
            const auto solver = named<Solver>(kSolvers, name, "solver");
            h.visit([&](auto& w) { w.set_solver(solver); });
          },
          "'soft_steps', 'sequential_impulses', 'jakobsen', 'xpbd' or 'direct'")
      .def_property(
          "threads", [](HeldWorld& h) { return h.visit([](auto& w) { return w.threads(); }); },
          [](HeldWorld& h, int threads) { h.visit([&](auto& w) { w.set_threads(threads); }); },
          "Threads that share a step.")
      .def_property_readonly(
          "precision", [](HeldWorld& h) { return kPrecisions[h.world.index()]; },
          "'float' or 'double', of the solver")
      .def(
          "set_sleeping", [](HeldWorld& h, Flag on) { h.visit([&](auto& w) { w.set_sleeping(on); }); },
          arg("on"), "Lets bodies fall asleep, or not.")
      .def(
          "set_continuous", [](HeldWorld& h, Flag on) { h.visit([&](auto& w) { w.set_continuous(on); }); },
          arg("on"), "Lets no fast body pass through others, or saves that time.")
      .def_property("sleeping", PLUMB_SETTING(sleeping), PLUMB_CHANGE(Flag, set_sleeping),
                    "False: no body falls asleep.")
      .def_property("continuous", PLUMB_SETTING(continuous), PLUMB_CHANGE(Flag, set_continuous),
                    "False lets fast bodies pass through others, to save time.")
      .def_property("direct_islands", PLUMB_SETTING(direct_islands), PLUMB_CHANGE(Flag, set_direct_islands),
                    "True: jointed bodies are solved as one, where it helps.")
      .def_property("quarantine", PLUMB_SETTING(quarantine), PLUMB_CHANGE(Flag, set_quarantine),
                    "True: a body whose numbers are not finite is taken out of the simulation.")
      .def_property("iterations", PLUMB_SETTING(iterations), PLUMB_CHANGE(int, set_iterations),
                    "Of solvers that iterate, 1 to 1000.")
      .def_property(
          "thresholds",
          [](HeldWorld& h) {
            const Thresholds t = h.visit([](auto& w) { return w.thresholds(); });
            return py::make_tuple(t.hit, t.bounce, t.sleep);
          },
          [](HeldWorld& h, const std::array<double, 3>& t) {
            h.visit([&](auto& w) { w.set_thresholds({t[0], t[1], t[2]}); });
          },
          "(hit, bounce, sleep), m/s: approach from which impacts are hits, up to which nothing bounces, "
          "speed up to "
          "which a body may fall asleep; negative: by the shapes' sizes.")
      .def(
          "set_profiling", [](HeldWorld& h, Flag on) { h.visit([&](auto& w) { w.set_profiling(on); }); },
          arg("on"), "Measures the stages of steps from now on, or not.")
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
      .def_property_readonly(
          "counts",
          [](HeldWorld& h) {
            const WorldCounts c = h.visit([](auto& w) { return w.counts(); });
            return py::dict(arg("bodies") = c.bodies, arg("awake") = c.awake, arg("shapes") = c.shapes,
                            arg("contacts") = c.contacts, arg("touching") = c.touching,
                            arg("joints") = c.joints);
          },
          "bodies, awake, shapes, contacts, touching and joints, a dict")
      .def(
          "create_body",
          [](const WorldPointer& h, const Shapes& shapes, const std::string& type, Vec2d position,
             double angle, Vec2d velocity, double angular_velocity, const std::string& name,
             std::optional<std::tuple<double, double, Vec2d>> mass, double gravity_scale,
             double linear_damping, double angular_damping, Flag lock_x, Flag lock_y, Flag lock_rotation,
             Flag may_sleep, Flag awake, std::uint64_t user_data, Flag continuous) {
            BodyDefinition b;
            b.name = name, b.type = named<BodyType>(kBodyTypes, type, "type");
            b.position = position, b.angle = angle, b.velocity = velocity,
            b.angular_velocity = angular_velocity;
            if (mass) b.mass = MassProperties{std::get<0>(*mass), std::get<2>(*mass), std::get<1>(*mass)};
            b.gravity_scale = gravity_scale, b.linear_damping = linear_damping,
            b.angular_damping = angular_damping;
            b.lock_x = lock_x, b.lock_y = lock_y, b.lock_rotation = lock_rotation;
            b.may_sleep = may_sleep, b.awake = awake, b.user_data = user_data;
            b.continuous = continuous;
            const std::vector<ShapeDefinition> all = definitions_of(shapes);
            h->leave_views_if_full();
            return HeldBody{h, h->visit([&](auto& w) { return w.create_body(b, all); })};
          },
          arg("shapes") = py::none(), py::kw_only(), arg("type") = "dynamic", arg("position") = Vec2d{},
          arg("angle") = 0.0, arg("velocity") = Vec2d{}, arg("angular_velocity") = 0.0, arg("name") = "",
          arg("mass") = py::none(), arg("gravity_scale") = 1.0, arg("linear_damping") = 0.0,
          arg("angular_damping") = 0.0, arg("lock_x") = false, arg("lock_y") = false,
          arg("lock_rotation") = false, arg("may_sleep") = true, arg("awake") = true, arg("user_data") = 0,
          arg("continuous") = true,
          "Creates a body. shapes: a geometry, a ShapeDefinition or a list of these; position: m; angle: "
          "rad; velocity: "
          "m/s; mass: (kg, kg m^2, centre in m), else densities count; damping: 1/s.")
      .def(
          "create_joint",
          [](const WorldPointer& h, const HeldBody& a, const HeldBody& b, const JointKind& kind, Flag collide,
             double break_force, double break_torque, std::uint64_t user_data, double report_force,
             double report_torque) {
            return HeldJoint{h, h->visit([&](auto& w) {
                               return w.create_joint(id_in(h, a, "a"), id_in(h, b, "b"),
                                                     {kind, collide, break_force, break_torque, user_data,
                                                      report_force, report_torque});
                             })};
          },
          arg("a"), arg("b"), arg("kind"), py::kw_only(), arg("collide") = false, arg("break_force") = 0.0,
          arg("break_torque") = 0.0, arg("user_data") = 0, arg("report_force") = 0.0,
          arg("report_torque") = 0.0,
          "Joins two bodies; break_force: N, break_torque: N m, 0: never; the same for the loads that are "
          "events.")
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
      .def_property_readonly(
          "moved",
          [](const WorldPointer& h) {
            return h->visit([&](auto& w) {
              std::vector<BodyId> all(w.moved({}));
              w.moved(all);
              return handles(h, all);
            });
          },
          "Bodies whose pose the last step may have changed; not sorted.")
      .def_property_readonly(
          "quarantined",
          [](const WorldPointer& h) {
            py::list all;
            h->visit([&](auto& w) {
              for (const QuarantineEvent& q : w.quarantined()) all.append(fault_of(h, q));
            });
            return all;
          },
          "Bodies in quarantine and their faults, oldest first: dicts of body, field, value and step.")
      .def("__repr__",
           [](HeldWorld& h) {
             return h.visit([&](auto& w) {
               const WorldCounts c = w.counts();
               return "<plumb.World, " + std::string(kPrecisions[h.world.index()]) + ": " +
                      std::to_string(c.bodies) + " bodies, " + std::to_string(c.joints) + " joints, step " +
                      std::to_string(w.step_count()) + ">";
             });
           })
      .def_property_readonly(
          "events", &events_of,
          "Of the last step, as lists: begin, end (shape, shape), sensor_begin, sensor_end (sensor, "
          "visitor), hits, loaded, quarantined (dicts, SI units), broken (joints), fell_asleep, "
          "woke (bodies).")
      .def(
          "on_pre_solve",
          [](HeldWorld& h, const std::optional<py::function>& hook) {
            h.visit([&](auto& w) {
              if (!hook) return w.on_pre_solve({});
              w.on_pre_solve([&h](const ContactReading& c) {
                const py::gil_scoped_acquire held;
                return returned<bool>(h.pre_solve(reading_of(h.shared_from_this(), c)),
                                      "the hook of on_pre_solve", kTrueOrFalse);
              });
            });
            h.pre_solve = hook ? py::object(*hook) : py::object();
          },
          arg("hook").none(true),
          "Calls hook(contact) for contacts of shapes with pre_solve; False disables one in this step.")
      .def(
          "on_filter",
          [](HeldWorld& h, const std::optional<py::function>& filter) {
            h.visit([&](auto& w) {
              if (!filter) return w.on_filter({});
              w.on_filter([&h](ShapeId a, ShapeId b) {
                const py::gil_scoped_acquire held;
                const WorldReference own = h.shared_from_this();
                return returned<bool>(h.filter(HeldShape{own, a}, HeldShape{own, b}),
                                      "the filter of on_filter", kTrueOrFalse);
              });
            });
            h.filter = filter ? py::object(*filter) : py::object();
          },
          arg("filter").none(true),
          "Calls filter(a, b) for shapes that come near each other and that their filters let touch; False: "
          "they do "
          "not collide. It must depend on the world's state alone.");
  bind_arrays(bound), bind_snapshots(bound), bind_queries(bound), bind_laws(module, bound);
  bind_rollback(module), bind_drawing(module, bound);
}

}  // namespace plumb::python
