// Checks parts of the world that no motion shows: tampered snapshots, loops shared by threads, monitors, and
// the methods that integrate free bodies.
#include <algorithm>
#include <atomic>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "engine/core/loop_scheduler.h"
#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "engine/world/add_scene.h"
#include "engine/world/checksum.h"
#include "engine/world/invariant_monitor.h"
#include "engine/world/snapshot.h"
#include "engine/world/world_data.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/random.h"

namespace plumb::harness::hunt {
namespace {

bool in_float(const Engine& engine) { return engine.kind == Engine::Kind::World; }

/// Returns an objection with the text `what`; nullopt if the text is empty.
Verdict objection(const char* name, std::string what, const char* right) {
  if (what.empty()) return {};
  return Objection{.law = name, .judge = name, .what = std::move(what), .right = right};
}

// The header of a snapshot: 8 bytes that identify the format, version, layout, then size and checksum of the
// rest.
constexpr std::size_t kHeader = 32, kSizeAt = 16, kSumAt = 24;
constexpr int kDamages = 40, kMostBytes = 60000;

void sign_anew(std::vector<std::byte>& bytes) {
  const std::span<const std::byte> content = std::span(bytes).subspan(kHeader);
  const std::uint64_t size = content.size(), sum = checksum(content);
  std::memcpy(bytes.data() + kSizeAt, &size, 8);
  std::memcpy(bytes.data() + kSumAt, &sum, 8);
}

/// Returns errors in the colours of joints and contacts. Constraints of one colour are solved in parallel, so
/// no two may share a dynamic body.
template <class Real>
std::string shared_colours(const BasicWorld<Real>& world) {
  const WorldData<Real>& w = world.data();
  std::set<std::pair<int, int>> taken;
  for (int joint = 0; joint < w.joint_set.slots(); ++joint) {
    if (!w.joint_set.contains(joint) || !w.joint_set.active(joint) ||
        w.joint_set.colour(joint) == w.joint_set.colours() - 1 ||
        std::holds_alternative<MouseDefinition>(w.joint_set.definition(joint)))
      continue;
    const auto [a, b] = w.joint_set.bodies(joint);
    for (const int body : {a, b})
      if (w.is_dynamic(body) && !taken.insert({w.joint_set.colour(joint), body}).second)
        return "two joints of one colour share a body";
  }
  return {};
}

template <class Real>
std::string damaged_world(const Case& one, std::string& flags) {
  BasicWorld<Real> world(world_definition(one.scene));
  add_scene(world, one.scene);
  Random random(one.seed, one.index + 31);
  for (int i = random.whole(1, 20); i > 0; --i) world.step(one.dt, one.substeps);
  if (std::string wrong = shared_colours(world); !wrong.empty()) return wrong;
  const std::vector<std::byte> sound = save(world);
  if (sound.size() > kMostBytes) return {};
  std::vector<std::byte> bytes = sound;
  for (int i = 0; i < kDamages; ++i) {
    const auto at = kHeader + static_cast<std::size_t>(random.unit() * double(sound.size() - kHeader));
    // Small bytes are mostly indices, counts and kinds: usually replace these with small values, and other
    // bytes with any value.
    const int old = static_cast<int>(sound[at]);
    bytes[at] =
        static_cast<std::byte>(old < 64 && random.chance(0.8) ? random.whole(0, 25) : random.whole(0, 255));
    const bool cut = random.chance(0.05);
    if (!cut && random.chance(0.9)) sign_anew(bytes);
    BasicWorld<Real> other;
    try {
      restore(other, std::span(bytes).first(cut ? at : bytes.size()));
      if (cut) return "a truncated snapshot is accepted";
      if (save(other) != bytes) return "a damaged snapshot is accepted, and differs when it is saved again";
      if (std::string wrong = shared_colours(other); !wrong.empty()) {
        flags = "a damaged snapshot is accepted: " + wrong;
        bytes = sound;
        continue;
      }
      other.step(one.dt, one.substeps);
      // Creates joints, which get the colours that are free according to the snapshot.
      const std::vector<BodyId> bodies = other.bodies();
      for (std::size_t k = 0; k + 1 < bodies.size() && k < 6; ++k) {
        other.create_joint(bodies[k], bodies[k + 1], {});
        if (std::string wrong = shared_colours(other); !wrong.empty())
          return "a damaged snapshot is accepted: " + wrong;
      }
      other.step(one.dt, one.substeps);
    } catch (const Error&) {
      // The snapshot is refused, or a step reports the invalid data.
    }
    bytes = sound;
  }
  return {};
}

// Checks that each block runs once, in the caller's floating-point environment, and that its exceptions are
// passed on.
std::string shared_loops(Random& random) {
  LoopScheduler scheduler;
  scheduler.set_threads(random.whole(2, 4)), scheduler.set_eager(true);
  scheduler.set_order(random.pick({LoopOrder::Ascending, LoopOrder::Descending, LoopOrder::Shuffled}));
  const int blocks = random.whole(2, 60), bad = random.chance(0.5) ? random.whole(0, blocks - 1) : -1;
  const int rounding = random.pick({FE_TONEAREST, FE_UPWARD, FE_DOWNWARD}), usual = std::fegetround();
  std::vector<std::atomic<int>> runs(static_cast<std::size_t>(blocks));
  std::atomic<bool> rounds_otherwise = false;
  std::fesetround(rounding);
  int caught = -1;
  try {
    scheduler.blocks(blocks, [&](int block) {
      // Long enough for other threads to arrive.
      volatile double sum = 0;
      for (int i = 0; i < 2000; ++i) sum = sum + i;
      ++runs[static_cast<std::size_t>(block)];
      if (std::fegetround() != rounding) rounds_otherwise = true;
      if (bad >= 0 && block >= bad && (block - bad) % 3 == 0) throw block;
    });
  } catch (int block) {
    caught = block;
  }
  std::fesetround(usual);
  if (rounds_otherwise) return "a block of a parallel loop has another rounding mode than its caller";
  if (caught != bad)
    return bad < 0 ? "a parallel loop throws an exception that no block threw"
                   : fmt::format("block {} of a parallel loop threw, and {} was passed on", bad,
                                 caught < 0 ? "nothing" : fmt::format("that of {}", caught));
  for (const auto& count : runs)
    if (count != 1) return fmt::format("a block of a parallel loop runs {} times", count.load());
  return {};
}

/// Steps a world with a monitor, and returns the field that the monitor reports; empty if it reports none.
template <class Real>
std::string violation_of(BasicWorld<Real>& world, int steps, const std::function<void()>& before_step = {},
                         int substeps = 4) {
  InvariantMonitor<Real> monitor(world);
  for (int i = 0; i < steps; ++i) {
    if (before_step) before_step();
    monitor.begin_step();
    world.step(1.0 / 60, substeps);
    if (const auto error = monitor.end_step()) return error->field();
  }
  return {};
}

template <class Real>
std::string watched(Random& random) {
  const double s = random.ladder(0.2, 5), m = random.ladder(0.1, 100);
  const MassProperties mass{m, {}, m * s * s / 6};
  const auto expect = [](const std::string& field, const std::string& right, const char* what) {
    if (field == right) return std::string();
    return fmt::format("a monitor says '{}', not '{}', of {}", field, right, what);
  };
  const WorldDefinition weightless{.gravity = {0, 0}, .sleeping = false};
  {
    // Walls hold a box that is wider than their gap.
    BasicWorld<Real> world(weightless);
    const double jam = random.within(0.05, 0.2) * s;
    for (const double side : {-1.0, 1.0})
      world.create_body({.type = BodyType::Static, .position = {side * (s - jam / 2), 0}},
                        {.geometry = Box{s, 4 * s}});
    world.create_body({.mass = mass}, {.geometry = Box{s, s}});
    if (std::string wrong = expect(violation_of(world, 90), "overlap", "a jammed box"); !wrong.empty())
      return wrong;
  }
  {
    // Two hinges hold a bar at points farther apart than the bar's anchors.
    BasicWorld<Real> world(weightless);
    const BodyId frame = world.create_body({.type = BodyType::Static}),
                 bar = world.create_body({.mass = mass});
    const double wide = random.within(1.1, 1.4);
    for (const double side : {-0.5 * s, 0.5 * s})
      world.create_joint(frame, bar,
                         {.kind = RevoluteDefinition{.anchor_a = {wide * side, 0}, .anchor_b = {side, 0}}});
    if (std::string wrong = expect(violation_of(world, 90), "gap", "a bar on hinges that are too far apart");
        !wrong.empty())
      return wrong;
  }
  {
    // A mass on a spring whose force the program adds before each step, with w h < 0.3. Explicit Euler gains
    // the fraction (w h)^2 of its energy per step; the exact method gains less than the bound.
    const bool makes = random.chance(0.5);
    const double w = random.within(10, 18), from = s;
    WorldDefinition definition = weightless;
    definition.integrator = makes ? Integrator::ExplicitEuler : Integrator::SemiImplicitEuler;
    BasicWorld<Real> world(definition);
    const BodyId body = world.create_body({.position = {from, 0}, .mass = mass});
    const auto pull = [&] { world.apply_force(body, {-w * w * m * world.position(body).x, 0}); };
    if (std::string wrong =
            expect(violation_of(world, 400, pull, 1), makes ? "energy" : "",
                   makes ? "an explicit method's spring" : "a spring pulled by an applied force");
        !wrong.empty())
      return wrong;
  }
  {
    // Pushes a body steadily, under gravity.
    BasicWorld<Real> world({.sleeping = false});
    const BodyId body = world.create_body({.mass = mass});
    const Vec2d force{m * random.within(1, 30), m * random.within(1, 30)};
    const auto push = [&] { world.apply_force(body, force); };
    if (std::string wrong = expect(violation_of(world, 90, push), "", "a body that is pushed");
        !wrong.empty())
      return wrong;
  }
  {
    // A motor turns a rod, and lifts it.
    BasicWorld<Real> world({.sleeping = false});
    const BodyId frame = world.create_body({.type = BodyType::Static});
    const BodyId rod = world.create_body({.position = {s, 0}, .mass = mass});
    const RevoluteDefinition hinge{.anchor_b = {-s, 0}, .motor = Motor{random.within(2, 6), 40 * m * s * s}};
    world.create_joint(frame, rod, {.kind = hinge});
    if (std::string wrong = expect(violation_of(world, 200), "", "a rod that a motor turns"); !wrong.empty())
      return wrong;
  }
  {
    // A box that overlaps another one and is pushed out slowly, so that the overlap shrinks.
    BasicWorld<Real> world({.sleeping = false});
    world.create_body({.type = BodyType::Static, .position = {0, -s}}, {.geometry = Box{40 * s, 2 * s}});
    const BodyId lower = world.create_body({.position = {0, 0.5 * s}}, {.geometry = Box{s, s}});
    const BodyId upper = world.create_body({.position = {0, 1.5 * s}}, {.geometry = Box{s, s}});
    static_cast<void>(lower);
    InvariantMonitor<Real> monitor(world);
    world.set_position(upper, {0, random.within(1.1, 1.4) * s}, 0);
    monitor.reset();
    for (int i = 0; i < 200; ++i) {
      monitor.begin_step();
      world.step(1.0 / 60, 4);
      if (const auto error = monitor.end_step())
        if (std::string wrong = expect(error->field(), "", "an overlap that dissolves"); !wrong.empty())
          return wrong;
    }
  }
  return {};
}

// Checks free fall by each method against the closed form of textbooks. With force laws, which are evaluated
// in substeps, a step of n substeps must equal n steps of one substep.
std::string integrated_by(Random& random, Precision precision) {
  const double dt = 1.0 / random.pick({30, 60, 120}), v = random.within(-5, 5), g = random.within(1, 20);
  const int substeps = random.whole(1, 8), steps = random.whole(2, 30);
  const double rounding = precision == Precision::Float ? 3e-6 : 1e-12;
  Scene fall{.name = "fall", .gravity = {0, -g}};
  fall.bodies = {{.name = "ball", .velocity = {1, v}, .shapes = {{.geometry = Circle{0.5}}}}};
  for (const Integrator integrator :
       {Integrator::VelocityVerlet, Integrator::SemiImplicitEuler, Integrator::ExplicitEuler}) {
    Simulation run = compile(
        fall, Realtime{.dt = dt, .substeps = substeps, .precision = precision, .integrator = integrator});
    run.step(steps);
    const double t = steps * dt, h = dt / substeps;
    const double sign = integrator == Integrator::VelocityVerlet      ? 0
                        : integrator == Integrator::SemiImplicitEuler ? 1
                                                                      : -1;
    const double right = v * t - 0.5 * g * t * t - sign * 0.5 * g * h * t, found = run.state(0).position.y;
    if (std::abs(found - right) > rounding * (std::abs(v) * t + g * t * t) * 10)
      return fmt::format("a fall by {} ends at {:.9g} m, not {:.9g}", name_of(integrator), found, right);
  }
  Scene driven{.name = "driven", .gravity = {0, 0}};
  driven.bodies = {{.name = "ball",
                    .position = {random.within(0.5, 2), 0.3},
                    .mass = random.within(0.5, 3),
                    .shapes = {{.geometry = Box{1, 0.5}}}}};
  driven.forces = {
      SpringForce{.body_a = std::string(kWorld),
                  .body_b = "ball",
                  .anchor_b = {0.1, 0.2},
                  .rest_length = 0.2,
                  .stiffness = random.within(5, 60)},
      SinusoidalForce{.body = "ball", .amplitude = {1, 2}, .angular_frequency = random.within(1, 9)}};
  Simulation coarse = compile(driven, Realtime{.dt = dt, .substeps = substeps, .precision = precision}),
             fine = compile(driven, Realtime{.dt = dt / substeps, .substeps = 1, .precision = precision});
  coarse.step(steps), fine.step(steps * substeps);
  const double off = length(coarse.state(0).position - fine.state(0).position);
  if (off > 1e3 * rounding)
    return fmt::format("{} steps of {} substeps end {:.3g} m away from {} steps of one substep", steps,
                       substeps, off, steps * substeps);
  return {};
}

std::string without_errors(const std::function<std::string()>& check) {
  try {
    return check();
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

Verdict damaged(const Case& one, const Engine& engine, const Motion&) {
  constexpr const char* kRight = "a tampered snapshot is rejected, or gives a consistent world";
  std::string flags;
  if (Verdict wrong = objection("damaged", without_errors([&] {
                                  return in_float(engine) ? damaged_world<float>(one, flags)
                                                          : damaged_world<double>(one, flags);
                                }),
                                kRight))
    return wrong;
  Verdict wrong = objection("damaged", flags, kRight);
  if (wrong) wrong->judge = "damaged_colours";
  return wrong;
}

Verdict loops(const Case& one, const Engine&, const Motion&) {
  Random random(one.seed, one.index + 37);
  return objection("loops", shared_loops(random),
                   "a parallel loop runs each block once, and passes on the first exception");
}

Verdict monitors(const Case& one, const Engine& engine, const Motion&) {
  Random random(one.seed, one.index + 41);
  return objection("monitors", in_float(engine) ? watched<float>(random) : watched<double>(random),
                   "a monitor reports violations, and nothing else");
}

Verdict integrators(const Case& one, const Engine& engine, const Motion&) {
  Random random(one.seed, one.index + 43);
  return objection("integrators",
                   integrated_by(random, in_float(engine) ? Precision::Float : Precision::Double),
                   "each method integrates a fall by its definition, and a step of n substeps is n steps");
}

}  // namespace plumb::harness::hunt
