#include "engine/simulation/simulation.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <thread>

#include "bindings/python/held_world.h"
#include "bindings/python/interrupt.h"
#include "engine/scene/json.h"
#include "engine/world/snapshot.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/validate.h"

namespace plumb::python {
namespace {

using py::arg;

constexpr std::array kViolations{"ignore", "report", "stop"};
constexpr std::array kMethods{"automatic", "explicit", "implicit", "symplectic"};

/// A compiled scene and the names of its bodies.
struct HeldSimulation {
  Simulation simulation;
  std::vector<std::string> names;

  std::size_t find(const std::variant<std::size_t, std::string>& body) const {
    if (const auto* index = std::get_if<std::size_t>(&body)) {
      if (*index < names.size()) return *index;
      throw Error(Error::Kind::Name, "simulation", "body", std::to_string(*index),
                  "the scene has " + std::to_string(names.size()) + " bodies, from 0");
    }
    const std::string& name = std::get<std::string>(body);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw Error(Error::Kind::Name, "simulation", "body", name, "the scene has no body of this name");
    return static_cast<std::size_t>(found - names.begin());
  }
};

std::string text_of(const py::object& scene) {
  if (py::isinstance<py::str>(scene)) return scene.cast<std::string>();
  return py::module_::import("plumb._json").attr("text")(scene).cast<std::string>();
}

HeldSimulation compiled(const py::object& scene, const Accuracy& accuracy) {
  const Scene read = scene_from_json(text_of(scene));
  std::vector<std::string> names;
  for (const Body& body : read.bodies) names.push_back(body.name);
  return {compile(read, accuracy), std::move(names)};
}

py::dict dict_of(const BodyState& s) {
  return py::dict(arg("position") = s.position, arg("angle") = s.angle, arg("velocity") = s.velocity,
                  arg("angular_velocity") = s.angular_velocity);
}

/// Copies of a world that step side by side, with forces on some of their bodies.
class Batch {
 public:
  Batch(const WorldPointer& world, int count, const std::vector<HeldBody>& bodies, int threads)
      : threads_(threads) {
    require_count("batch", "count", count, 1), require_threads(threads);
    if (world->has_hooks()) {
      throw Error(Error::Kind::Unsupported, "batch", "hooks", "",
                  "of the world are not copied; take them off before (None), and give each copy its own hook "
                  "by batch.world(index)");
    }
    world->visit([&](auto& w) { initial_ = save(w); });
    for (const HeldBody& body : bodies) {
      if (!(body.world == world))
        throw Error(Error::Kind::Name, "batch", "bodies", std::to_string(body.id.index),
                    "is of another world");
      world->visit([&](auto& w) { w.position(body.id); });  // throws for the handle of a destroyed body
      if (std::find(ids_.begin(), ids_.end(), body.id) != ids_.end())
        throw Error(Error::Kind::Value, "batch", "bodies", std::to_string(body.id.index), "is given twice");
      ids_.push_back(body.id);
    }
    for (int i = 0; i < count; ++i) {
      worlds_.emplace_back(world->visit([&]<class Real>(BasicWorld<Real>&) {
        BasicWorld<Real> copy;
        restore(copy, initial_);
        return std::make_shared<HeldWorld>(std::move(copy));
      }));
    }
  }

  template <class Visit>
  void traverse(Visit&& visit) const {
    for (const WorldReference& world : worlds_) world.traverse(visit);
  }

  int size() const { return static_cast<int>(worlds_.size()); }
  WorldPointer world(int index) const {
    if (index >= 0 && index < size()) return worlds_[static_cast<std::size_t>(index)].pointer();
    throw Error(Error::Kind::Name, "batch", "index", std::to_string(index),
                "the batch has " + std::to_string(size()) + " worlds, from 0");
  }
  std::vector<std::uint64_t> hashes() const {
    std::vector<std::uint64_t> all;
    for (const WorldReference& world : worlds_) all.push_back(world->visit([](auto& w) { return w.hash(); }));
    return all;
  }

  using Actions = py::array_t<double, py::array::c_style | py::array::forcecast>;
  py::array_t<double> step(const std::optional<Actions>& actions, double dt, int substeps, int count) {
    require_count("batch", "count", count, 0);
    const std::size_t width = 3 * ids_.size();
    if (actions && (actions->ndim() != 3 || actions->shape(0) != size() ||
                    actions->shape(1) != static_cast<py::ssize_t>(ids_.size()) || actions->shape(2) != 3)) {
      throw Error(Error::Kind::Value, "batch", "actions", "an array of another shape",
                  "must be (" + std::to_string(size()) + ", " + std::to_string(ids_.size()) +
                      ", 3): force (N) and torque (N m) on each body of each world");
    }
    const double* given = actions ? actions->data() : nullptr;
    require_steppable(dt, substeps), require_actions(given);
    {
      const py::gil_scoped_release released;
      std::atomic<bool> stopped = false;
      share([&](std::size_t first, std::size_t last) {
        // Python runs handlers of signals on the calling thread, which has the first part.
        InterruptCheck interrupted;
        const auto check = [&] {
          try {
            if (first == 0) interrupted();
          } catch (...) {
            stopped = true;
            throw;
          }
        };
        for (std::size_t i = first; i < last; ++i) {
          worlds_[i]->visit([&](auto& w) {
            for (int k = 0; k < count && !stopped; ++k, check()) {
              for (std::size_t body = 0; given != nullptr && body < ids_.size(); ++body) {
                const double* row = given + i * width + 3 * body;
                w.apply_force(ids_[body], Vec2d{row[0], row[1]});
                if (row[2] != 0) w.apply_torque(ids_[body], row[2]);
              }
              w.step(dt, substeps);
            }
          });
        }
      });
    }
    return observe();
  }

  py::array_t<double> observe() const {
    py::array_t<double> out(
        {static_cast<py::ssize_t>(size()), static_cast<py::ssize_t>(ids_.size()), py::ssize_t{6}});
    double* to = out.mutable_data();
    for (const WorldReference& world : worlds_) {
      world->visit([&](auto& w) {
        for (const BodyId body : ids_) {
          const Vec2d position = w.position(body), velocity = w.velocity(body);
          for (const double number :
               {position.x, position.y, w.angle(body), velocity.x, velocity.y, w.angular_velocity(body)})
            *to++ = number;
        }
      });
    }
    return out;
  }

  void reset(const std::optional<std::vector<Flag>>& which) {
    if (which && which->size() != worlds_.size())
      throw Error(Error::Kind::Value, "batch", "which", std::to_string(which->size()) + " values",
                  "must have one for each world");
    for (std::size_t i = 0; i < worlds_.size(); ++i) {
      if (which && !(*which)[i]) continue;
      worlds_[i]->leave_views();
      worlds_[i]->visit([&](auto& w) { restore(w, initial_); });
    }
  }

 private:
  // A call is refused as a whole, before any world changes.
  void require_steppable(double dt, int substeps) const {
    require_positive("step", "dt", dt);
    if (substeps < 1 || substeps > 1000)
      throw Error(Error::Kind::Value, "step", "substeps", std::to_string(substeps),
                  "must be a number from 1 to 1000");
    for (const WorldReference& world : worlds_) {
      world->visit([&](auto& w) {
        require_unlocked(w.data());
        for (const BodyId body : ids_) (void)w.type(body);  // throws for one that was destroyed in its copy
      });
    }
  }
  void require_actions(const double* given) const {
    constexpr const char* kColumns[] = {"force x", "force y", "torque"};
    const std::size_t width = 3 * ids_.size(), count = given != nullptr ? width * worlds_.size() : 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (std::abs(given[i]) <= kLargestNumber) continue;
      const std::size_t world = i / width, row = i % width / 3, column = i % 3;
      require_finite("batch",
                     "actions[" + std::to_string(world) + ", " + std::to_string(row) + ", " +
                         std::to_string(column) + "], " + kColumns[column] + " of world " +
                         std::to_string(world),
                     given[i]);
    }
  }

  /// Calls `work(first, last)` for parts of the worlds, on threads; the first exception goes on.
  template <class Work>
  void share(Work&& work) {
    const std::size_t parts = std::min(static_cast<std::size_t>(threads_), worlds_.size());
    std::vector<std::exception_ptr> thrown(parts);
    const auto part = [&](std::size_t i) {
      try {
        work(worlds_.size() * i / parts, worlds_.size() * (i + 1) / parts);
      } catch (...) {
        thrown[i] = std::current_exception();
      }
    };
    {
      std::vector<std::jthread> others;
      for (std::size_t i = 1; i < parts; ++i) others.emplace_back(part, i);
      part(0);
    }
    for (const std::exception_ptr& each : thrown) {
      if (each) std::rethrow_exception(each);
    }
  }

  int threads_;
  std::vector<std::byte> initial_;
  std::vector<BodyId> ids_;
  std::vector<WorldReference> worlds_;
};

}  // namespace

void bind_simulation(py::module_& module) {
  const Realtime r;
  const Precise p;
  py::class_<HeldSimulation>(module, "Simulation",
                             "A scene, a dict or JSON as docs/scene.md has it, that is stepped in fixed "
                             "steps or to a tolerance. SI units.")
      .def_static(
          "realtime",
          [](const py::object& scene, double dt, int substeps, int iterations, const std::string& precision,
             const std::string& integrator, const std::string& solver, Flag continuous, Flag sleeping,
             const std::string& on_violation) {
            return compiled(scene, Realtime{dt, substeps, iterations,
                                            named<Precision>(kPrecisions, precision, "precision"),
                                            named<Integrator>(kIntegrators, integrator, "integrator"),
                                            named<Solver>(kSolvers, solver, "solver"), continuous, sleeping,
                                            named<OnViolation>(kViolations, on_violation, "on_violation")});
          },
          arg("scene"), py::kw_only(), arg("dt") = r.dt, arg("substeps") = r.substeps,
          arg("iterations") = r.iterations, arg("precision") = "double",
          arg("integrator") = "velocity_verlet", arg("solver") = "soft_steps", arg("continuous") = true,
          arg("sleeping") = false, arg("on_violation") = "ignore", "Fixed steps of dt, s.")
      .def_static(
          "precise",
          [](const py::object& scene, double tolerance, double dt, const std::string& method,
             Flag estimate_error) {
            return compiled(scene, Precise{tolerance, dt, named<MotionMethod>(kMethods, method, "method"),
                                           estimate_error});
          },
          arg("scene"), py::kw_only(), arg("tolerance") = p.tolerance, arg("dt") = p.max_dt,
          arg("method") = "automatic", arg("estimate_error") = false,
          "Adaptive steps: `tolerance` is the local error a step, relative to the scene's own length and "
          "speed; `step` advances by dt, s.")
      .def(
          "step",
          [](HeldSimulation& s, int count) {
            const py::gil_scoped_release released;
            InterruptCheck interrupted;
            if (count < 1) return s.simulation.step(count);  // refuses negative ones
            for (int i = 0; i < count; ++i) s.simulation.step(1), interrupted();
          },
          arg("count") = 1, "Takes `count` steps of dt, s.")
      .def_property_readonly(
          "time", [](const HeldSimulation& s) { return s.simulation.time(); }, "s")
      .def_property_readonly(
          "names", [](const HeldSimulation& s) { return s.names; }, "Of the bodies, by index.")
      .def(
          "state",
          [](const HeldSimulation& s, const std::variant<std::size_t, std::string>& body) {
            return dict_of(s.simulation.state(s.find(body)));
          },
          arg("body"), "State of a body's centre of mass, by name or index: m, rad, m/s, rad/s.")
      .def(
          "set_state",
          [](HeldSimulation& s, const std::variant<std::size_t, std::string>& body, Vec2d position,
             double angle, Vec2d velocity, double angular_velocity) {
            s.simulation.set_state(s.find(body), {position, angle, velocity, angular_velocity});
          },
          arg("body"), arg("position"), arg("angle") = 0.0, arg("velocity") = Vec2d{},
          arg("angular_velocity") = 0.0, "Sets the state of a body's centre of mass: m, rad, m/s, rad/s.")
      .def_property_readonly(
          "states",
          [](const HeldSimulation& s) {
            // A state is six numbers in a row.
            static_assert(sizeof(BodyState) == 6 * sizeof(double));
            std::vector<BodyState> states(s.names.size());
            s.simulation.read(states);
            py::array_t<double> out({static_cast<py::ssize_t>(states.size()), py::ssize_t{6}});
            std::copy_n(reinterpret_cast<const double*>(states.data()), 6 * states.size(),
                        out.mutable_data());
            return out;
          },
          "x, y (m), angle (rad), velocity (m/s), angular velocity (rad/s) of all bodies, (n, 6)")
      .def(
          "hash", [](const HeldSimulation& s) { return s.simulation.hash(); }, "Hash of all bodies' states.")
      .def(
          "save",
          [](const HeldSimulation& s) {
            const std::vector<std::byte> bytes = s.simulation.save();
            return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
          },
          "All that the future depends on, as bytes.")
      .def(
          "restore",
          [](HeldSimulation& s, const py::buffer& given) { s.simulation.restore(Bytes(given).all()); },
          arg("bytes"), "Goes back to a saved state.")
      .def(
          "forces",
          [](const HeldSimulation& s) {
            const Reactions all = s.simulation.forces();
            py::list joints, contacts;
            for (const JointReaction& j : all.joints)
              joints.append(py::dict(arg("joint") = j.joint, arg("position") = j.position,
                                     arg("force") = j.force, arg("torque") = j.torque));
            for (const ContactReaction& c : all.contacts)
              contacts.append(py::dict(arg("body_a") = s.names[c.body_a], arg("body_b") = s.names[c.body_b],
                                       arg("position") = c.position, arg("normal") = c.normal,
                                       arg("normal_force") = c.normal_force,
                                       arg("tangent_force") = c.tangent_force));
            return py::dict(arg("joints") = joints, arg("contacts") = contacts);
          },
          "Forces (N) and torques (N m) of joints and lasting contacts; precise runs alone.")
      .def_property_readonly(
          "statistics",
          [](const HeldSimulation& s) {
            const Statistics t = s.simulation.statistics();
            py::dict all(arg("steps") = t.steps, arg("rejected") = t.rejected, arg("impacts") = t.impacts,
                         arg("evaluations") = t.evaluations);
            if (t.error.known)
              all["error"] = py::dict(arg("position") = t.error.position, arg("angle") = t.error.angle,
                                      arg("velocity") = t.error.velocity);
            return all;
          },
          "Steps taken and rejected, impacts, evaluations; with estimate_error the error: m, "
          "rad, m/s.")
      .def_property_readonly(
          "plan",
          [](const HeldSimulation& s) {
            py::list stages;
            for (const Stage& stage : s.simulation.plan().stages)
              stages.append(
                  py::dict(arg("name") = stage.name, arg("why") = stage.why, arg("active") = stage.active));
            return stages;
          },
          "The stages of a step, with the reasons why this scene needs them.")
      .def_property_readonly(
          "violation",
          [](const HeldSimulation& s) -> std::optional<std::string> {
            const Error* violation = s.simulation.violation();
            if (violation == nullptr) return std::nullopt;
            return violation->what();
          },
          "The first missed bound as a sentence, or None.");

  py::class_<Batch>(module, "Batch", traversed<Batch>(),
                    "Copies of a world that step side by side: `bodies` feel actions and are observed; "
                    "`threads` share the worlds. Hooks are not copied: a world that has one is refused.")
      .def(py::init<const WorldPointer&, int, const std::vector<HeldBody>&, int>(), arg("world"),
           arg("count"), arg("bodies"), py::kw_only(), arg("threads") = 1)
      .def("__len__", [](const Batch& b) { return b.size(); })
      .def("world", &Batch::world, arg("index"), "One of the copies, from 0.")
      .def(
          "hashes", [](const Batch& b) { return b.hashes(); }, "World.hash() of each copy.")
      .def("step", &Batch::step, arg("actions") = py::none(), py::kw_only(), arg("dt") = 1.0 / 60,
           arg("substeps") = 4, arg("count") = 1,
           "Applies actions, (worlds, bodies, 3): force (N) and torque (N m), in each of `count` steps; "
           "returns `observe()`.")
      .def(
          "observe", [](const Batch& b) { return b.observe(); },
          "(worlds, bodies, 6): x, y (m), angle (rad), velocity (m/s), angular velocity (rad/s).")
      .def("reset", &Batch::reset, arg("which") = py::none(),
           "Takes all worlds, or those of a mask, back to the start.");

  module.def(
      "scene_from_json",
      [](const std::string& text) {
        return py::module_::import("json").attr("loads")(to_json(scene_from_json(text)));
      },
      arg("text"), "Reads and validates a scene; returns it as a dict with all defaults.");
}

}  // namespace plumb::python
