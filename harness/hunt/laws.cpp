#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/energy.h"
#include "harness/hunt/objection.h"
#include "harness/hunt/subject.h"

namespace plumb::harness::hunt {
namespace {

// Semi-implicit Euler conserves an energy that differs from the true one by a fraction of w h / 2.
constexpr double kEnergyShare = 0.02, kMostShare = 0.3;
constexpr double kPreciseShare = 1e-5;
// s, processor time that a step may cost per body or joint: thirty times that of the costliest scenes drawn,
// so that a slow machine is not mistaken for an endless search.
constexpr double kCost = 1e-3;
// 1/s: bodies slower than this fraction of their extents a second fall asleep, by the world's definition.
constexpr double kSleepShare = 0.05;

/// Energies that bound a motion's energy.
struct Budget {
  double start = 0, kinetic = 0, fall = 0, fastest_turn = 0;
};

// Returns the energy due to position errors: half a step's displacement and a hundredth of the extent of each
// body, in its gravity.
double slack_of_places(const Case& one, const Sample& sample, const std::vector<double>& extent) {
  double sum = 0;
  const double g = length(one.scene.gravity);
  for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
    const Body& body = one.scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    const double way = std::min(length(sample.states[i].velocity) * one.dt, extent[i]);
    sum +=
        body.mass * std::abs(body.gravity_scale) * g * (0.5 * way + 0.01 * extent[i] + g * one.dt * one.dt);
    sum += body.mass * 1e-6 * extent[i] * extent[i];
  }
  return sum;
}

// Returns the energy error that a tolerance of 1e-9 permits for bodies at rest: each body is displaced by
// 1e-6 of its extent, and moves at 1e-6 extents per second.
double slack_of_rounding(const Case& one, const std::vector<double>& extent) {
  double sum = 0;
  for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
    const Body& body = one.scene.bodies[i];
    const double off = 1e-6 * extent[i];
    if (body.type == BodyType::Dynamic)
      sum += body.mass * (std::abs(body.gravity_scale) * length(one.scene.gravity) * off + off * off);
  }
  return sum;
}

bool left_alone(const Case& one) {
  if (driven(one) || !one.scene.forces.empty()) return false;
  for (const Body& body : one.scene.bodies) {
    if (body.type != BodyType::Dynamic && (!body.shapes.empty())) return false;
    if (body.linear_damping != 0 || body.lock_x || body.lock_y) return false;
  }
  for (const Joint& joint : one.scene.joints) {
    const bool held = std::visit(
        [&](const auto& j) {
          const auto fixed = [&](const std::string& name) {
            const auto at = find_body(one.scene, name);
            return !at || one.scene.bodies[*at].type != BodyType::Dynamic;
          };
          return fixed(j.body_a) || fixed(j.body_b);
        },
        joint);
    if (held || std::holds_alternative<PulleyJoint>(joint)) return false;
  }
  return true;
}

struct Sizes {
  double mass = 0, mass_times_extent = 0, mass_times_extent_squared = 0;
};

Sizes sizes_of(const Scene& scene) {
  Sizes out;
  const std::vector<double> extent = extents(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    out.mass += body.mass;
    out.mass_times_extent += body.mass * extent[i];
    out.mass_times_extent_squared += body.mass * extent[i] * extent[i];
  }
  return out;
}

std::size_t dynamic_bodies(const Scene& scene) {
  return static_cast<std::size_t>(std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                                [](const Body& b) { return b.type == BodyType::Dynamic; }));
}

}  // namespace

const std::vector<Law>& laws() {
  static const std::vector<Law> all{{"finite", finite_law},
                                    {"expectation", expectation_law},
                                    {"energy", energy_law},
                                    {"joint_gap", joint_gap_law},
                                    {"joint_angle", joint_angle_law},
                                    {"penetration", penetration_law},
                                    {"momentum", momentum_law},
                                    {"angular_momentum", angular_momentum_law},
                                    {"events", event_law},
                                    {"sensors", sensor_law},
                                    {"sleep", sleep_law},
                                    {"cost", cost_law}};
  return all;
}

Verdict finite_law(const Case& one, const Engine&, const Motion& motion) {
  if (motion.failure.empty()) return {};
  return Objection{.judge = "finite",
                   .what = motion.failure,
                   .right = "the run continues to its end with finite states",
                   .time = static_cast<double>(motion.samples.size()) * one.dt};
}

Verdict cost_law(const Case& one, const Engine& engine, const Motion& motion) {
  if (!engine.is_world() || motion.costs.empty()) return {};
  const double most = kCost * static_cast<double>(1 + one.scene.bodies.size() + one.scene.joints.size());
  for (std::size_t k = 0; k < motion.costs.size(); ++k) {
    if (motion.costs[k] <= most) continue;
    // Other processes may have delayed the step. It is repeated: a step that is really slow takes as long
    // each time.
    double least = motion.costs[k];
    for (int again = 0; again < 3 && least > most; ++again) {
      Case part = one;
      part.steps = static_cast<int>(k) + 1;
      const Motion other = run(engine, part);
      least = other.costs.size() > k ? std::min(least, other.costs[k]) : 0;
    }
    if (least <= most) continue;
    return Objection{.judge = "cost",
                     .what = fmt::format("step {} takes {:.3g} s", k + 1, least),
                     .right = "the cost of a step is bounded by the number of bodies and joints",
                     .figure = least,
                     .bound = most,
                     .unit = "s",
                     .time = static_cast<double>(k + 1) * one.dt};
  }
  return {};
}

namespace {

// Returns true if force laws act that grow without bound where bodies meet, as attraction does, and with an
// eighth of the step the gain is less than a quarter. The gain is then an integration error of a close pass,
// which vanishes with the step.
bool is_of_the_step(const Case& one, const Engine& engine, std::size_t sample, double gain, double rest) {
  if (std::none_of(one.scene.forces.begin(), one.scene.forces.end(),
                   [](const ForceLaw& law) { return std::holds_alternative<AttractionForce>(law); }))
    return false;
  const Motion finer = run(engine, one, {.refine = 8});
  if (finer.samples.size() <= sample) return false;
  const Mechanics then = mechanics(one.scene, finer.samples[sample].states);
  return then.kinetic + then.potential - rest < 0.25 * gain;
}

}  // namespace

Verdict energy_law(const Case& one, const Engine& engine, const Motion& motion) {
  if (driven(one) || motion.samples.empty() || !starts_closed(one.scene) || !starts_apart(one.scene))
    return {};
  const bool precise = engine.kind == Engine::Kind::Precise;
  const std::vector<double> extent = extents(one.scene);
  const Mechanics first = mechanics(one.scene, motion.samples.front().states);
  Budget budget{.start = first.kinetic + first.potential, .kinetic = first.kinetic};
  for (std::size_t k = 1; k < motion.samples.size(); ++k) {
    const Mechanics now = mechanics(one.scene, motion.samples[k].states);
    const double time = static_cast<double>(k) * one.dt, given = stored(one.scene, time);
    budget.fall = std::max(budget.fall, first.potential - now.potential);
    const double share =
        precise ? kPreciseShare
                : std::min(kMostShare, kEnergyShare + 0.5 * budget.fastest_turn * one.dt / one.substeps);
    double bound = share * (budget.kinetic + budget.fall + given);
    bound += precise ? slack_of_rounding(one, extent) : slack_of_places(one, motion.samples[k], extent);
    const double gain = now.kinetic + now.potential - budget.start - given;
    if (gain > bound) {
      if (engine.is_world() && is_of_the_step(one, engine, k, gain, budget.start + given)) return {};
      return Objection{.judge = "energy",
                       .what = fmt::format("energy has grown by {:.3g} J; {:.3g} J was available", gain,
                                           budget.kinetic + budget.fall + given),
                       .right = "energy never exceeds that at the start plus the work of springs and motors",
                       .figure = gain,
                       .bound = bound,
                       .unit = "J",
                       .time = time};
    }
    if (!one.scene.joints.empty() && budget.fastest_turn == 0)
      for (std::size_t i = 0; i < one.scene.bodies.size(); ++i)
        budget.fastest_turn =
            std::max(budget.fastest_turn, std::abs(motion.samples.front().states[i].angular_velocity));
  }
  return {};
}

Verdict momentum_law(const Case& one, const Engine& engine, const Motion& motion) {
  if (!left_alone(one) || motion.samples.empty() || dynamic_bodies(one.scene) == 0) return {};
  const Mechanics first = mechanics(one.scene, motion.samples.front().states);
  Vec2d weight{};
  for (const Body& body : one.scene.bodies)
    if (body.type == BodyType::Dynamic) weight += body.mass * body.gravity_scale * one.scene.gravity;
  const Sizes sizes = sizes_of(one.scene);
  const double duration = one.steps * one.dt;
  const std::vector<double> extent = extents(one.scene);
  // kg m/s: momentum that bodies lost when they fell asleep.
  double slept = 0;
  // Rounding moves bodies even at rest: tolerate a displacement of their extent over the whole run.
  double most = std::max(first.sum_of_momenta, sizes.mass_times_extent / duration);
  for (std::size_t k = 1; k < motion.samples.size(); ++k) {
    const double time = static_cast<double>(k) * one.dt;
    const Mechanics now = mechanics(one.scene, motion.samples[k].states);
    // By Cauchy-Schwarz sum |m v| <= sqrt(2 sum m sum m v^2 / 2), so the available energy limits it.
    const double allowed = std::sqrt(2 * sizes.mass * (first.kinetic + stored(one.scene, time)));
    most = std::max(most, std::min(now.sum_of_momenta, allowed + length(weight) * time));
    for (std::size_t i = 0; i < one.scene.bodies.size(); ++i)
      if (motion.samples[k].asleep[i] && !motion.samples[k - 1].asleep[i])
        slept += kSleepShare * 2 * extent[i] * one.scene.bodies[i].mass;
    const double off = length(now.momentum - first.momentum - time * weight);
    const double roundings = 8.0 * static_cast<double>(k) * one.substeps + 100;
    const double tolerance = engine.kind == Engine::Kind::Precise ? 1e-6 : 0;
    // Continuous collision stops fast bodies in front of an obstacle: their weight does not act in the rest
    // of that step. Tolerate a few such impacts.
    const double unfallen = dynamic_bodies(one.scene) > 1 && engine.is_world()
                                ? length(weight) * one.dt * static_cast<double>(std::min<std::size_t>(k, 8))
                                : 0;
    const double bound =
        (engine.epsilon() * roundings + tolerance) * (most + length(weight) * time) + unfallen + slept;
    if (off > bound && off > 0) {
      return Objection{.judge = "momentum",
                       .what = fmt::format("the sum of momenta is off by {:.3g} kg m/s", off),
                       .right = "momentum is conserved to rounding: gravity is the only external force",
                       .figure = off,
                       .bound = bound,
                       .unit = "kg m/s",
                       .time = time};
    }
  }
  return {};
}

Verdict angular_momentum_law(const Case& one, const Engine& engine, const Motion& motion) {
  if (!left_alone(one) || motion.samples.empty() || length(one.scene.gravity) > 0) return {};
  for (const Body& body : one.scene.bodies)
    if (body.angular_damping != 0 || body.fixed_rotation) return {};
  const auto about_centre = [&](const Sample& sample) {
    Vec2d centre{};
    double mass = 0;
    for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
      if (one.scene.bodies[i].type != BodyType::Dynamic) continue;
      centre += one.scene.bodies[i].mass * sample.states[i].position;
      mass += one.scene.bodies[i].mass;
    }
    std::vector<BodyState> states = sample.states;
    for (BodyState& state : states) state.position -= (1 / mass) * centre;
    return mechanics(one.scene, states);
  };
  if (dynamic_bodies(one.scene) == 0) return {};
  const Mechanics first = about_centre(motion.samples.front());
  const Sizes sizes = sizes_of(one.scene);
  double most = first.sum_of_angular_momenta, impulse = 0;
  for (std::size_t k = 1; k < motion.samples.size(); ++k) {
    const Mechanics now = about_centre(motion.samples[k]);
    const double time = static_cast<double>(k) * one.dt;
    const double energy = first.kinetic + stored(one.scene, time);
    most = std::max(most, std::min(now.sum_of_angular_momenta, 4 * most));
    // The line of action of an impulse J between bodies that pass each other at v is off by at most a step's
    // displacement v dt.
    impulse = std::max(impulse, 2 * energy * one.dt);
    const double off = std::abs(now.angular_momentum - first.angular_momentum);
    const double share = engine.kind == Engine::Kind::Precise ? 1e-6 : 0.05;
    const double rounding = engine.epsilon() * (8.0 * static_cast<double>(k) * one.substeps + 100) *
                            sizes.mass_times_extent_squared / (one.steps * one.dt);
    const double bound = share * most + rounding + (engine.kind == Engine::Kind::Precise ? 0 : 4 * impulse);
    if (off > bound && off > 0) {
      return Objection{.judge = "angular_momentum",
                       .what = fmt::format("the sum of angular momenta is off by {:.3g} kg m^2/s", off),
                       .right = "angular momentum is conserved: there is no external force",
                       .figure = off,
                       .bound = bound,
                       .unit = "kg m^2/s",
                       .time = time};
    }
  }
  return {};
}

}  // namespace plumb::harness::hunt
