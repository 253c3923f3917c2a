#include "harness/hunt/relations.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/hunt/subject.h"
#include "harness/hunt/views.h"

namespace plumb::harness::hunt {
namespace {

constexpr double kPerturbation = 1e-6;
// Largest distance between motions that count as equal, as a fraction of the largest body; the effect of
// perturbations must stay below kCalm of the body.
constexpr double kShare = 0.1, kCalm = 0.01;
// kSampled: the same distance for an engine with a tolerance of 1e-9. kGrown: largest growth of
// perturbations; errors of the tolerance then stay below a hundredth of kSampled.
constexpr double kSampled = 1e-4, kGrown = 1000;
constexpr double kTighter = 1e-11;  // tolerance of Precise here; otherwise it is usually 1e-9
constexpr double kShift = 64;       // m, a power of two

// Formulas use the scene's own coordinates: a shifted or mirrored scene would need others.
bool plain(const Case& one, const Engine&) { return !one.world_only() && !has_formulas(one.scene); }

template <class Map>
Motion mapped(Motion motion, const Map& map) {
  for (Sample& sample : motion.samples)
    for (BodyState& state : sample.states) state = map(state);
  return motion;
}

Motion reversed(Motion motion) {
  for (Sample& sample : motion.samples) std::reverse(sample.states.begin(), sample.states.end());
  return motion;
}

/// Objects if the other run deviates from the first one although perturbations of the first one do not.
Verdict compare(const Case& one, const Engine& engine, const Motion& motion, const Motion& other,
                const std::string& name, const std::string& right, double share = kShare) {
  if (!motion.failure.empty()) return {};
  const std::vector<double> off = apart(one, motion, other);
  const double bound = share * largest_size(one.scene);
  std::size_t k = 0;
  while (k < off.size() && off[k] <= bound) ++k;
  if (k == off.size()) return {};
  const std::vector<double> calm = growth(one, engine, motion);
  if (k >= calm.size() || calm[k] > kCalm * bound) return {};
  return Objection{.law = name,
                   .judge = name,
                   .what = fmt::format(
                       "differs by {:.3g} m from the other run; a perturbation of 1e-6 has grown to {:.2g} m",
                       off[k], calm[k]),
                   .right = right,
                   .figure = off[k],
                   .bound = bound,
                   .unit = "m",
                   .time = static_cast<double>(k) * one.dt};
}

Verdict mirror(const Case& one, const Engine& engine, const Motion& motion) {
  const Motion other = mapped(run(engine, mirrored(one)), [](const BodyState& s) { return mirrored(s); });
  return compare(one, engine, motion, other, "mirror", "a mirrored scene has the mirrored motion");
}

Verdict turn(const Case& one, const Engine& engine, const Motion& motion) {
  const Motion other = mapped(run(engine, turned(one)), [](const BodyState& s) { return turned(s); });
  return compare(one, engine, motion, other, "turn",
                 "a scene that is rotated together with gravity has the rotated motion");
}

Verdict shift(const Case& one, const Engine& engine, const Motion& motion) {
  const Vec2d by{kShift, -kShift};
  const Motion other = mapped(run(engine, shifted(one, by)), [by](BodyState s) {
    s.position -= by;
    return s;
  });
  return compare(one, engine, motion, other, "shift",
                 "the motion does not depend on the position of the scene");
}

Verdict relabel(const Case& one, const Engine& engine, const Motion& motion) {
  const Motion other = reversed(run(engine, relabelled(one)));
  return compare(one, engine, motion, other, "relabel",
                 "the motion does not depend on the order of bodies and joints", 2 * kShare);
}

// Depth, as a fraction of the smaller extent, from which bodies may be pushed out of each other at a limited
// speed. Resting ones overlap by a fifth of it. A World limits the speed from 55 substeps, in s, on: 0.014
// for the shortest ones of the grammar, 1/3840 s.
constexpr double kPushed = 0.01;

// Returns the first sample at which shapes that may touch overlap by more than kPushed.
std::size_t first_pushed(const Case& one, const Motion& motion) {
  OverlapTest overlaps(one.scene);
  std::size_t k = 0;
  while (k < motion.samples.size() && !overlaps.exceeds(motion.samples[k].states, kPushed)) ++k;
  return k;
}

// Scales masses by sixteen, lengths by two and times by two: speeds and forces change with them. The speed at
// which a World pushes bodies out of each other is limited in extents a second, which depends on the unit of
// time, so motions are compared until bodies may be pushed that fast.
Verdict units(const Case& one, const Engine& engine, const Motion& motion) {
  Motion other = mapped(run(engine, rescaled(one, 2, 2, 16)), [](BodyState s) {
    s.position = 0.5 * s.position;
    return s;
  });
  const std::size_t end = std::min(first_pushed(one, motion), first_pushed(one, other));
  if (end < other.samples.size()) other.samples.resize(end);
  return compare(one, engine, motion, other, "units",
                 "the motion does not depend on the units of length, time and mass");
}

Verdict sleep(const Case& one, const Engine& engine, const Motion& motion) {
  const Motion other = run(engine, one, {.flip_sleep = true});
  return compare(one, engine, motion, other, "sleep_switch", "sleep does not change the motion", 5 * kShare);
}

/// Returns true if a perturbation of the velocities halfway, or after three quarters, grows more than
/// kGrown-fold up to sample `end`. Perturbing the start is not enough: a body that comes to rest in an
/// unstable equilibrium (a needle that stands at a wall) has lost all perturbations of the start.
bool is_unstable_later(const Case& one, const Engine& engine, const Motion& motion, std::size_t end) {
  if (!one.scene.forces.empty()) return false;  // they may depend on the time
  for (const std::size_t from : {end / 2, end - end / 4}) {
    Case later = one;
    later.steps = static_cast<int>(end - from);
    if (from == 0 || later.steps == 0) continue;
    for (std::size_t i = 0; i < later.scene.bodies.size(); ++i) {
      if (later.scene.bodies[i].type != BodyType::Dynamic) continue;
      const BodyState& state = motion.samples[from].states[i];
      Body& body = later.scene.bodies[i];
      body.position = state.position, body.angle = state.angle;
      body.velocity = state.velocity, body.angular_velocity = state.angular_velocity;
    }
    const Motion plain = run(engine, later);
    for (const std::uint64_t seed : {1, 2, 3}) {
      Case pushed = perturbed(later, kPerturbation, seed);
      for (std::size_t i = 0; i < pushed.scene.bodies.size(); ++i) {
        pushed.scene.bodies[i].position = later.scene.bodies[i].position;
        pushed.scene.bodies[i].angle = later.scene.bodies[i].angle;
      }
      const std::vector<double> off = apart(one, plain, run(engine, pushed));
      if (!off.empty() && off.back() > kGrown * kPerturbation * largest_size(one.scene)) return true;
    }
  }
  return false;
}

// Compares with a run that is sampled only at its end. An engine that chooses its steps must also handle
// everything between samples.
Verdict sampling(const Case& one, const Engine& engine, const Motion& motion) {
  if (!motion.failure.empty() || motion.samples.size() != static_cast<std::size_t>(one.steps) + 1) return {};
  Case coarse = one;
  coarse.dt = one.dt * one.steps, coarse.steps = 1;
  const Motion other = run(engine, coarse);
  if (other.samples.size() != 2) return {};
  Motion ends{.dt = coarse.dt};
  ends.samples = {motion.samples.front(), motion.samples.back()};
  const double off = apart(one, ends, other).back(), bound = kSampled * largest_size(one.scene);
  if (off <= bound) return {};
  // If a perturbation grows more than a thousandfold, the motion is chaotic, and errors of the tolerance may
  // show.
  const std::vector<double> calm = growth(one, engine, motion);
  if (calm.size() != motion.samples.size() ||
      calm.back() > kGrown * 30 * kPerturbation * largest_size(one.scene) ||
      is_unstable_later(one, engine, motion, motion.samples.size() - 1))
    return {};
  return Objection{.law = "sampling",
                   .judge = "sampling",
                   .what = fmt::format("differs by {:.3g} m if it is sampled only once, at the end", off),
                   .right = "the motion does not depend on when it is sampled",
                   .figure = off,
                   .bound = bound,
                   .unit = "m",
                   .time = coarse.dt};
}

// Compares Precise with itself at a hundredth of its tolerance.
Verdict tolerance(const Case& one, const Engine& engine, const Motion& motion) {
  if (!motion.failure.empty()) return {};
  const Motion other = run(engine, one, {.tolerance = kTighter});
  const std::vector<double> off = apart(one, motion, other);
  const double bound = kSampled * largest_size(one.scene);
  std::size_t k = 0;
  while (k < off.size() && off[k] <= bound) ++k;
  if (k == off.size()) return {};
  const std::vector<double> calm = growth(one, engine, motion);
  if (k >= calm.size() || calm[k] > kGrown * 30 * kPerturbation * largest_size(one.scene) ||
      is_unstable_later(one, engine, motion, k))
    return {};
  return Objection{.law = "tolerance",
                   .judge = "tolerance",
                   .what = fmt::format("differs by {:.3g} m at a tolerance of {}", off[k], kTighter),
                   .right = "the motion agrees with that at a tighter tolerance",
                   .figure = off[k],
                   .bound = bound,
                   .unit = "m",
                   .time = static_cast<double>(k) * one.dt};
}

bool unscaled(const Case& one, const Engine& engine) {
  return plain(one, engine) && engine.is_world() && one.scene.forces.empty() && !one.sleeping;
}
bool is_precise(const Case&, const Engine& engine) { return engine.kind == Engine::Kind::Precise; }
bool plain_world(const Case& one, const Engine& engine) { return plain(one, engine) && engine.is_world(); }
bool smooth_discs(const Case& one, const Engine&) { return are_smooth_discs(one); }
bool law_free(const Case& one, const Engine& engine) {
  return plain(one, engine) &&
         std::none_of(one.scene.forces.begin(), one.scene.forces.end(), [](const auto& law) {
           return std::holds_alternative<PointForce>(law) || std::holds_alternative<SinusoidalForce>(law) ||
                  std::holds_alternative<Torque>(law);
         });
}

}  // namespace

std::vector<double> apart(const Case& one, const Motion& a, const Motion& b) {
  const std::vector<double> extent = extents(one.scene);
  std::vector<double> out;
  for (std::size_t k = 0; k < std::min(a.samples.size(), b.samples.size()); ++k) {
    double most = 0;
    for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
      if (one.scene.bodies[i].type != BodyType::Dynamic || !a.samples[k].present[i]) continue;
      const BodyState &s = a.samples[k].states[i], &t = b.samples[k].states[i];
      most = std::max(most, length(s.position - t.position) + extent[i] * std::abs(s.angle - t.angle));
    }
    out.push_back(most);
  }
  return out;
}

std::vector<double> growth(const Case& one, const Engine& engine, const Motion& motion) {
  std::vector<double> out(motion.samples.size(), 0);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Case off_a_little = perturbed(one, seed == 3 ? 30 * kPerturbation : kPerturbation, seed);
    const Motion other = run(engine, off_a_little);
    const std::vector<double> off = apart(one, motion, other);
    out.resize(std::min(out.size(), off.size()));
    double most = 0;
    for (std::size_t k = 0; k < out.size(); ++k) {
      most = std::max(most, off[k]);
      out[k] = std::max(out[k], most);
    }
  }
  return out;
}

const std::vector<Relation>& relations() {
  static const std::vector<Relation> all{{"mirror", law_free, mirror},
                                         {"turn", law_free, turn},
                                         {"shift", law_free, shift},
                                         {"relabel", plain, relabel},
                                         {"units", unscaled, units},
                                         {"sleep_switch", plain_world, sleep},
                                         {"precise", plain_world, precise_relation},
                                         {"jury", plain, jury_relation},
                                         {"sampling", is_precise, sampling},
                                         {"tolerance", is_precise, tolerance},
                                         {"integrated", plain, integrated_relation},
                                         {"as_formulas", has_laws_as_formulas, as_formulas_relation},
                                         {"collisions", smooth_discs, collisions_relation}};
  return all;
}

}  // namespace plumb::harness::hunt
