// Compares with other engines: with Precise alone, and with a majority of Precise and the rivals.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "harness/hunt/objection.h"
#include "harness/hunt/relations.h"
#include "harness/hunt/subject.h"

namespace plumb::harness::hunt {

namespace {

constexpr double kSeconds = 0.5;   // time limit of another engine
constexpr double kShare = 0.2;     // tolerance, as a fraction of the largest body's size
constexpr std::size_t kMost = 12;  // largest number of dynamic bodies for Precise
constexpr double kCalm = 0.02;
// Largest change of a rival's motion when its step is halved, as a fraction of the bound. A first-order error
// halves as well, so the error is twice the change.
constexpr double kSteady = 0.25;

/// Returns the possible error of a first-order method at each sample, m: the displacement of three steps, at
/// the bodies' largest speed plus that of free fall.
std::vector<double> bounds(const Case& one, const Motion& motion) {
  std::vector<double> out;
  const double g = length(one.scene.gravity), share = kShare * largest_size(one.scene);
  double fastest = 0;
  for (std::size_t k = 0; k < motion.samples.size(); ++k) {
    for (std::size_t i = 0; i < one.scene.bodies.size(); ++i)
      if (one.scene.bodies[i].type == BodyType::Dynamic)
        fastest = std::max(fastest, length(motion.samples[k].states[i].velocity));
    out.push_back(share + 3 * one.dt * (fastest + g * static_cast<double>(k) * one.dt));
  }
  return out;
}

std::optional<Motion> run_by(const char* name, const Case& one) {
  const reference::Backend& backend = reference::find_backend(name);
  if (!backend.identity().available) return {};
  const Engine engine(backend);
  if (!unsupported(engine, one).empty()) return {};
  Motion out = run(engine, one, {.seconds = kSeconds});
  if (out.samples.empty()) return {};
  // An engine that gains energy is no reference: Newton's law of restitution with friction may gain energy
  // (Kane, Levinson 1985).
  if (energy_law(one, engine, out)) return {};
  return out;
}

// Returns true if forces change so much within a step that methods with fixed steps miss the change.
bool has_quick_forces(const Case& one) {
  const auto is_quick = [&](const ForceLaw& law) {
    if (const auto* force = std::get_if<SinusoidalForce>(&law))
      return force->angular_frequency * one.dt > 0.5;
    if (const auto* force = std::get_if<PointForce>(&law)) return std::isfinite(force->duration);
    const auto* torque = std::get_if<Torque>(&law);
    return torque != nullptr && std::isfinite(torque->duration);
  };
  return std::any_of(one.scene.forces.begin(), one.scene.forces.end(), is_quick);
}

// Returns false for cases without a reliable reference: initial overlaps or joint errors are resolved
// differently by each engine.
bool judged(const Case& one, const Motion& motion) {
  // Free bodies under forces are judged by `integrated`, whose bound depends on the strength of the forces.
  return motion.failure.empty() && !integrable(one) && !has_quick_forces(one) && starts_closed(one.scene) &&
         starts_apart(one.scene) && one.scene.bodies.size() <= 3 * kMost;
}

/// Returns the first sample at which `a` deviates from `b` by more than its bound; nullopt if it does not
/// before either run ends.
std::optional<std::size_t> parting(const Case& one, const Motion& a, const Motion& b,
                                   const std::vector<double>& bound, double times = 1) {
  const std::vector<double> off = apart(one, a, b);
  for (std::size_t k = 0; k < off.size(); ++k)
    if (off[k] > times * bound[k]) return k;
  return {};
}

/// Returns true if an engine's motion up to sample `k` stays within `kSteady` of the bound with half the
/// step. Always true for Precise, which chooses its own steps.
bool steady(const Case& one, const char* name, const Motion& motion, const std::vector<double>& bound,
            std::size_t k) {
  const Engine engine(reference::find_backend(name));
  if (engine.kind == Engine::Kind::Precise) return true;
  const std::vector<double> off =
      apart(one, motion, run(engine, one, {.refine = 2, .seconds = 2 * kSeconds}));
  if (off.size() <= k) return false;
  for (std::size_t i = 0; i <= k; ++i)
    if (off[i] > kSteady * bound[i]) return false;
  return true;
}

Objection objection(const std::string& name, const Case& one, double off, double bound, std::size_t k,
                    const std::string& right) {
  return {.law = name,
          .judge = name,
          .what = fmt::format("is {:.3g} m off", off),
          .right = right,
          .figure = off,
          .bound = bound,
          .unit = "m",
          .time = static_cast<double>(k) * one.dt};
}

}  // namespace

Verdict precise_relation(const Case& one, const Engine& engine, const Motion& motion) {
  const auto dynamic = std::count_if(one.scene.bodies.begin(), one.scene.bodies.end(),
                                     [](const Body& b) { return b.type == BodyType::Dynamic; });
  if (!judged(one, motion) || static_cast<std::size_t>(dynamic) > kMost) return {};
  const auto precise = run_by("plumb-precise", one);
  if (!precise) return {};
  const std::vector<double> bound = bounds(one, *precise);
  const auto k = parting(one, motion, *precise, bound);
  if (!k) return {};
  // If a perturbation within a step's error leads to a different motion, both motions are correct.
  const std::vector<double> calm = growth(one, engine, motion);
  const std::vector<double> own = growth(one, Engine(reference::find_backend("plumb-precise")), *precise);
  if (*k >= calm.size() || *k >= own.size() || std::max(calm[*k], own[*k]) > kCalm * kCalm * bound[*k])
    return {};
  return objection("precise", one, apart(one, motion, *precise)[*k], bound[*k], *k,
                   "the motion of Precise differs by more than perturbations of it do");
}

Verdict jury_relation(const Case& one, const Engine& engine, const Motion& motion) {
  if (!judged(one, motion)) return {};
  std::vector<Motion> jury;
  std::vector<const char*> names;
  for (const char* name : {"plumb-precise", "box2d", "bullet"}) {
    if (engine.name() == name) continue;
    if (auto other = run_by(name, one)) jury.push_back(std::move(*other)), names.push_back(name);
  }
  if (jury.size() < 2) return {};
  std::vector<double> bound = bounds(one, jury.front());
  for (const Motion& other : jury) bound.resize(std::min(bound.size(), other.samples.size()));
  bound.resize(std::min(bound.size(), motion.samples.size()));
  std::vector<std::vector<double>> from_jury, among_jury;
  for (std::size_t i = 0; i < jury.size(); ++i) {
    from_jury.push_back(apart(one, motion, jury[i]));
    for (std::size_t j = i + 1; j < jury.size(); ++j) among_jury.push_back(apart(one, jury[i], jury[j]));
  }
  for (std::size_t k = 0; k < bound.size(); ++k) {
    double among = 0, nearest = INFINITY;
    for (const auto& off : from_jury) nearest = std::min(nearest, off[k]);
    for (const auto& off : among_jury) among = std::max(among, off[k]);
    if (among > bound[k]) return {};
    if (nearest <= 2 * bound[k]) continue;
    const std::vector<double> calm = growth(one, engine, motion);
    if (k >= calm.size() || calm[k] > kCalm * bound[k]) return {};
    for (std::size_t i = 0; i < jury.size(); ++i)
      if (!steady(one, names[i], jury[i], bound, k)) return {};
    return objection("jury", one, nearest, 2 * bound[k], k,
                     "the other engines agree with each other, but not with this one");
  }
  return {};
}

}  // namespace plumb::harness::hunt
