#include "harness/hunt/world_run.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "engine/core/text.h"
#include "engine/joints/kind_of.h"
#include "engine/math/vector_width.h"
#include "engine/scene/error.h"
#include "engine/world/add_scene.h"
#include "engine/world/invariant_monitor.h"
#include "engine/world/rollback.h"
#include "engine/world/scene/scene_forces.h"
#include "engine/world/snapshot.h"
#include "engine/world/world_data.h"
#include "harness/hunt/answers.h"
#include "harness/hunt/processor_time.h"
#include "harness/hunt/run_mode.h"

namespace plumb::harness::hunt {
namespace {

using Key = std::pair<std::uint32_t, std::uint32_t>;

template <class Tag>
Key key_of(Handle<Tag> handle) {
  return {handle.index, handle.generation};
}

std::pair<std::string, std::string> ends_of(const Joint& joint) {
  return std::visit([](const auto& j) { return std::pair(j.body_a, j.body_b); }, joint);
}
const std::string& name_of(const Joint& joint) {
  return std::visit([](const auto& j) -> const std::string& { return j.name; }, joint);
}

/// Matches begin events with end events. Shapes are identified by the bodies that they belonged to.
class EventBook {
  using Pairs = std::set<std::pair<Key, Key>>;
  using Changes = std::map<std::pair<Key, Key>, int>;

 public:
  void know(ShapeId shape, std::size_t body) { bodies_[key_of(shape)] = body; }
  bool knows(ShapeId shape) const { return bodies_.contains(key_of(shape)); }

  void read(const Events& events, double time, std::vector<Motion::EventFault>& faults) {
    Changes touches, visits;
    for (const TouchEvent& event : events.begin) ++touches[pair(event)];
    for (const TouchEvent& event : events.end) --touches[pair(event)];
    for (const SensorEvent& event : events.sensor_begin)
      ++visits[{key_of(event.sensor), key_of(event.visitor)}];
    for (const SensorEvent& event : events.sensor_end)
      --visits[{key_of(event.sensor), key_of(event.visitor)}];
    apply("touch", touches, touches_, time, faults);
    apply("visit to a sensor", visits, visits_, time, faults);
  }

  /// Reports events that began and have not ended although one of the shapes was destroyed.
  template <class Real>
  void look(const BasicWorld<Real>& world, double time, std::vector<Motion::EventFault>& faults) {
    const auto gone = [&](Key key) { return !world.valid(ShapeId{key.first, key.second}); };
    const auto report_destroyed = [&](const char* what, std::set<std::pair<Key, Key>>& pairs) {
      for (auto at = pairs.begin(); at != pairs.end();) {
        if (!gone(at->first) && !gone(at->second)) {
          ++at;
          continue;
        }
        faults.push_back({time, fmt::format("a {} does not end when one of its shapes is destroyed", what)});
        at = pairs.erase(at);
      }
    };
    report_destroyed("touch", touches_);
    report_destroyed("visit to a sensor", visits_);
  }

  std::vector<Visit> visits() const {
    std::vector<Visit> out;
    for (const auto& [sensor, visitor] : visits_) {
      const auto a = bodies_.find(sensor), b = bodies_.find(visitor);
      if (a != bodies_.end() && b != bodies_.end()) out.push_back({a->second, b->second});
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

 private:
  static std::pair<Key, Key> pair(const TouchEvent& event) {
    return std::minmax(key_of(event.shape_a), key_of(event.shape_b));
  }
  // Applies events to the set of pairs: a begin and an end in one step cancel.
  static void apply(const char* what, const Changes& changes, Pairs& pairs, double time,
                    std::vector<Motion::EventFault>& faults) {
    for (const auto& [pair, change] : changes) {
      const int open = (pairs.contains(pair) ? 1 : 0) + change;
      if (open > 1) faults.push_back({time, fmt::format("a {} begins again before it ended", what)});
      if (open < 0) faults.push_back({time, fmt::format("a {} ends that never began", what)});
      if (open > 0) {
        pairs.insert(pair);
      } else {
        pairs.erase(pair);
      }
    }
  }

  Pairs touches_, visits_;
  std::map<Key, std::size_t> bodies_;
};

/// Returns true if unbreakable joints have springs, or motors with a speed: they do work.
bool is_driven_by_joints(const Scene& scene) {
  return std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) {
    return std::visit(
        [](const auto& j) {
          if (j.break_force > 0 || j.break_torque > 0) return false;
          bool drives = false;
          if constexpr (requires { j.spring.has_value(); }) drives = j.spring.has_value();
          if constexpr (requires { j.motor->speed; }) drives = drives || (j.motor && j.motor->speed != 0);
          return drives;
        },
        joint);
  });
}

/// Sets the width of vector registers during its lifetime.
class WithWidth {
 public:
  explicit WithWidth(RunMode mode) {
    if (mode == RunMode::Scalar) set_vector_width(VectorWidth::None);
    if (mode == RunMode::Narrow) set_vector_width(std::min(before_, VectorWidth::Bytes16));
  }
  ~WithWidth() { set_vector_width(before_); }
  WithWidth(const WithWidth&) = delete;
  WithWidth& operator=(const WithWidth&) = delete;

 private:
  VectorWidth before_ = vector_width();
};

// Interval, in steps, of shorter steps in runs whose digests are compared.
constexpr int kBetweenShort = 3;
// Steps that a world runs ahead before it is rolled back, and interval, in steps, of such rollbacks.
constexpr int kAhead = 3, kBetween = 4;
// Intervals, in steps, of restores, of reading everything, and of refused calls. Each costs as much as a
// step or more.
constexpr int kBetweenRestores = 9, kBetweenReads = 5, kBetweenRefusals = 40;

template <class Real>
class Run {
 public:
  Run(const Case& one, const RunOptions& options)
      : case_(one), options_(options), world_(definition()), bodies_(one.scene.bodies.size()) {
    for (const Action& action : one.actions) {
      if (action.kind == ActionKind::Create || action.kind == ActionKind::CreateJoint)
        later_.insert(action.target);
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (!later_.contains(one.scene.bodies[i].name)) create(i);
    for (const Joint& joint : one.scene.joints)
      if (!later_.contains(name_of(joint))) create(joint);
    prepare();
  }

  Motion go() {
    const double begin = processor_seconds();
    Motion out{.dt = case_.dt};
    SceneParts parts;
    for (const auto& id : bodies_) parts.bodies.push_back(id.value_or(BodyId{}));
    parts.frame = frame_.value_or(BodyId{});
    SceneForces<Real> forces(case_.scene, parts);
    out.samples.push_back(sample(out));
    for (int step = 0; step < case_.steps; ++step) {
      act(step);
      for (int part = 0; part < options_.refine; ++part) {
        const double dt = step_of(step) / options_.refine;
        forces.apply(world_, dt);
        if (monitor_) monitor_->begin_step();
        const double from = processor_seconds();
        world_.step(dt, case_.substeps);
        if (part == 0) out.costs.push_back(processor_seconds() - from);
        if (monitor_)
          if (const auto error = monitor_->end_step();
              error && case_.actions.empty() && is_driven_by_joints(case_.scene) &&
              std::string(error->what()).find("energy") != std::string::npos)
            out.broken_promise = fmt::format(
                "a monitor reports the work of a motor or spring as a violation: {}", error->what());
        if (!world_.events().quarantined.empty()) {
          const QuarantineEvent& bad = world_.events().quarantined.front();
          out.failure = fmt::format("body '{}' was quarantined at step {}: {} is {}", bad.name, step + 1,
                                    kBadFieldNames[static_cast<std::size_t>(bad.field)], bad.value);
          return out;
        }
        const double time = case_.dt * step + dt * (part + 1);
        book_.read(world_.events(), time, out.event_faults);
        book_.look(world_, time, out.event_faults);
      }
      out.samples.push_back(sample(out));
      if (!case_.sensors.empty()) out.visits.push_back(book_.visits());
      if (options_.digests) out.digests.push_back(digest_of(world_));
      after(step, out);
      if (over_ || !out.broken_promise.empty()) break;
      if (processor_seconds() - begin > options_.seconds) break;
    }
    return out;
  }

 private:
  WorldDefinition definition() const {
    WorldDefinition out = world_definition(case_.scene);
    out.sleeping = case_.sleeping != options_.flip_sleep;
    if (options_.mode == RunMode::Threaded) out.threads = 2;
    return out;
  }

  // Returns the length of a step, s. Some are a quarter when digests are compared, because steps of varying
  // length, as in games, make a world depend on the step before.
  double step_of(int step) const {
    return options_.digests && step % kBetweenShort == kBetweenShort - 1 ? 0.25 * case_.dt : case_.dt;
  }

  // Applies the parts of a run mode that are there from the start.
  void prepare() {
    if (options_.mode == RunMode::Threaded) world_.data().scheduler.set_eager(true);
    if (options_.mode == RunMode::Observed) monitor_.emplace(world_), world_.set_profiling(true);
    if (options_.mode == RunMode::RolledBack) states_.emplace(world_, 2);
    if (options_.mode == RunMode::Labelled) label(world_);
  }

  // Applies the parts of a run mode that follow a step.
  void after(int step, Motion& out) {
    if (options_.mode == RunMode::Restored && step % kBetweenRestores == kBetweenRestores - 1) {
      BasicWorld<Real> other(contrary(definition()));
      populate(other);
      restore(other, save(world_));
      if (digest_of(other).whole != digest_of(world_).whole)
        out.broken_promise = "a restored world differs from the saved one";
      world_ = std::move(other);
    }
    if (options_.mode == RunMode::RolledBack && step % kBetween == kBetween - 1) {
      // Events of the last step are not part of a state.
      const std::int64_t now = world_.step_count();
      const std::uint64_t before = digest_of(world_).whole;
      states_->save();
      for (int i = 0; i < kAhead; ++i) world_.step(case_.dt, case_.substeps);
      states_->back_to(now);
      if (digest_of(world_).whole != before)
        out.broken_promise = "a world that was rolled back differs from the saved one";
    }
    if (options_.mode == RunMode::Observed && step % kBetweenReads == 0) read_everything(world_);
    if (options_.mode == RunMode::Overrun && step == case_.steps / 2) {
      out.broken_promise = overrun(world_, case_.dt, case_.substeps);
      over_ = true;
    }
    if (options_.mode == RunMode::Asked && step % kBetweenReads == 0)
      out.broken_promise = wrong_answer(world_, case_.index + static_cast<std::uint64_t>(step));
    if (options_.mode == RunMode::Refused && step % kBetweenRefusals == 0)
      out.broken_promise = not_refused(world_);
  }

  Sample sample(const Motion& before) const {
    const std::size_t count = bodies_.size();
    Sample out{std::vector<BodyState>(count), std::vector<bool>(count, false),
               std::vector<bool>(count, false)};
    for (std::size_t i = 0; i < count; ++i) {
      out.present[i] = bodies_[i].has_value();
      if (out.present[i]) {
        out.states[i] = world_.state(*bodies_[i]);
        // Static bodies of a scene are placed by their origins, which need not be the centres of their
        // shapes.
        if (case_.scene.bodies[i].type == BodyType::Static)
          out.states[i].position = world_.position(*bodies_[i]);
        out.asleep[i] = world_.type(*bodies_[i]) == BodyType::Dynamic && !world_.awake(*bodies_[i]);
      } else {
        out.states[i] =
            before.samples.empty() ? initial_state(case_.scene.bodies[i]) : before.samples.back().states[i];
      }
    }
    return out;
  }

  void create(std::size_t index) {
    Scene alone{.name = "one body", .bodies = {case_.scene.bodies[index]}};
    Body& body = alone.bodies.front();
    const bool sensor =
        std::find(case_.sensors.begin(), case_.sensors.end(), body.name) != case_.sensors.end();
    std::vector<Shape> shapes;
    if (sensor) {
      if (!body.inertia && body.type == BodyType::Dynamic) body.inertia = inertia_of(body);
      shapes = std::exchange(body.shapes, {});
    }
    bodies_[index] = add_scene(world_, alone).bodies.front();
    for (const Shape& shape : shapes) {
      ShapeDefinition definition{
          .position = shape.position, .angle = shape.angle, .filter = shape.filter, .sensor = true};
      std::visit(
          [&](const auto& geometry) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(geometry)>, Chain>)
              definition.geometry = geometry;
          },
          shape.geometry);
      world_.create_shape(*bodies_[index], definition);
    }
    for (const ShapeId shape : world_.shapes(*bodies_[index])) book_.know(shape, index);
  }

  BodyId end(const std::string& name) {
    if (name != kWorld) return bodies_[*find_body(case_.scene, name)].value();
    if (!frame_) frame_ = world_.create_body(BodyDefinition{.type = BodyType::Static});
    return *frame_;
  }

  void create(const Joint& joint) {
    const auto [a, b] = ends_of(joint);
    const JointDefinition definition = std::visit(
        [&](const auto& j) {
          return JointDefinition{.kind = kind_of(joint),
                                 .collide = j.collide,
                                 .break_force = j.break_force,
                                 .break_torque = j.break_torque};
        },
        joint);
    joints_[name_of(joint)] = world_.create_joint(end(a), end(b), definition);
  }

  void act(int step) {
    for (const Action& action : case_.actions)
      if (action.step == step) act(action);
  }

  void act(const Action& action) {
    if (action.kind == ActionKind::CreateJoint) {
      for (const Joint& joint : case_.scene.joints) {
        const auto [a, b] = ends_of(joint);
        const auto there = [&](const std::string& name) {
          const auto body = find_body(case_.scene, name);
          return !body || bodies_[*body];
        };
        if (name_of(joint) == action.target && there(a) && there(b)) create(joint);
      }
      return;
    }
    if (action.kind == ActionKind::DestroyJoint) {
      const auto at = joints_.find(action.target);
      if (at != joints_.end() && world_.valid(at->second)) world_.destroy(at->second);
      return;
    }
    const auto index = find_body(case_.scene, action.target);
    if (!index) return;
    std::optional<BodyId>& body = bodies_[*index];
    if (action.kind == ActionKind::Create) {
      if (!body) create(*index);
      return;
    }
    if (body) act(action, *body, *index);
  }

  void act(const Action& action, BodyId body, std::size_t index) {
    switch (action.kind) {
      case ActionKind::Destroy:
        world_.destroy(body);
        bodies_[index].reset();
        break;
      case ActionKind::Teleport:
        world_.set_position(body, action.position, action.angle);
        break;
      case ActionKind::Push:
        world_.set_velocity(body, action.position);
        world_.set_angular_velocity(body, action.angle);
        break;
      case ActionKind::SetType:
        world_.set_type(body, action.type);
        break;
      case ActionKind::SetFilter:
        for (const ShapeId shape : world_.shapes(body))
          world_.set_filter(shape, action.touches ? Filter{} : Filter{.category = 1, .mask = 0});
        break;
      case ActionKind::DestroyShape:
        if (const auto shapes = world_.shapes(body); !shapes.empty()) world_.destroy(shapes.back());
        break;
      case ActionKind::Sleep:
        world_.set_awake(body, false);
        break;
      case ActionKind::Create:
      case ActionKind::CreateJoint:
      case ActionKind::DestroyJoint:
        break;
    }
  }

  const Case& case_;
  const RunOptions& options_;
  BasicWorld<Real> world_;
  std::vector<std::optional<BodyId>> bodies_;
  std::map<std::string, JointId> joints_;
  std::optional<BodyId> frame_;
  std::set<std::string> later_;
  EventBook book_;
  std::optional<InvariantMonitor<Real>> monitor_;
  std::optional<Rollback<Real>> states_;
  bool over_ = false;
};

}  // namespace

template <class Real>
Motion run_world(const Case& one, const RunOptions& options) {
  const WithWidth width(options.mode);
  std::optional<Run<Real>> run;
  try {
    run.emplace(one, options);
  } catch (const Error& error) {
    return {.dt = one.dt, .samples = {}, .failure = fmt::format("it was rejected: {}", error.what())};
  }
  try {
    return run->go();
  } catch (const std::exception& error) {
    return {.dt = one.dt, .samples = {}, .failure = error.what()};
  }
}

template Motion run_world<float>(const Case&, const RunOptions&);
template Motion run_world<double>(const Case&, const RunOptions&);

}  // namespace plumb::harness::hunt
