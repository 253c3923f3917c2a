#include "harness/reality/drops.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/reality/drop_fit.h"
#include "harness/reality/drop_motion.h"

namespace plumb::harness::reality {
namespace {

/// Tolerance of the exact motion that engines are compared with.
constexpr double kExact = 1e-9;

/// Number of drops of the training half to which a law is fitted.
constexpr std::size_t kFittedDrops = 120;

Poses run(const reference::Backend& engine, const DropStart& start, const DropLaw& law,
          std::span<const double> values, double dt) {
  const Scene scene = scene_of(start, law, values);
  const auto frames = frames_of(start, scene, values);
  const int steps_a_frame = static_cast<int>(std::lround(1 / (dt * kFramesPerSecond)));
  std::array<MeasuredPose, kTimes.size()> out;
  try {
    const auto simulator = engine.create(scene, {.dt = dt});
    std::vector<BodyState> states(scene.bodies.size());
    int now = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      simulator->advance((frames[i] - now) * steps_a_frame);
      now = frames[i];
      simulator->read(states);
      out[i] = pose_of(states[1]);
      if (!std::isfinite(out[i].position.x + out[i].position.y + out[i].angle)) return {};
    }
  } catch (const Error&) {
    return {};
  }
  return out;
}

double distance(const MeasuredPose& a, const MeasuredPose& b) {
  return std::sqrt(length_squared(a.position - b.position));
}

/// Distances of pairs of motions at a time.
struct Distances {
  std::vector<double> lengths, angles;
};

Distances distances(const std::vector<Poses>& a, const std::vector<Poses>& b, const std::vector<Poses>& also,
                    std::size_t time) {
  Distances out;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!a[i] || !b[i] || !also[i]) continue;
    out.lengths.push_back(distance((*a[i])[time], (*b[i])[time]));
    out.angles.push_back(std::abs((*a[i])[time].angle - (*b[i])[time].angle));
  }
  return out;
}

Differences differences(const std::vector<Poses>& a, const std::vector<Poses>& b, std::uint64_t seed) {
  Differences out;
  for (std::size_t time = 0; time < kTimes.size(); ++time) {
    const Distances all = distances(a, b, a, time);
    out.position[time] = estimate(all.lengths, 0.5, seed);
    out.ninetieth[time] = estimate(all.lengths, 0.9, seed);
    out.angle[time] = estimate(all.angles, 0.5, seed);
    out.angle_ninetieth[time] = estimate(all.angles, 0.9, seed);
  }
  return out;
}

/// Returns the error of `found` against `exact` over that of `exact` against `seen`, drop by drop.
Differences shares(const std::vector<Poses>& found, const std::vector<Poses>& exact,
                   const std::vector<Poses>& seen, std::uint64_t seed) {
  Differences out;
  for (std::size_t time = 0; time < kTimes.size(); ++time) {
    const Distances numerical = distances(found, exact, seen, time),
                    law = distances(exact, seen, found, time);
    out.position[time] = ratio(numerical.lengths, law.lengths, 0.5, seed);
    out.ninetieth[time] = ratio(numerical.lengths, law.lengths, 0.9, seed);
    out.angle[time] = ratio(numerical.angles, law.angles, 0.5, seed);
    out.angle_ninetieth[time] = ratio(numerical.angles, law.angles, 0.9, seed);
  }
  return out;
}

}  // namespace

DropFindings examine_drops(std::span<const MeasuredDrop> drops,
                           std::span<const reference::Backend* const> engines, std::uint64_t seed) {
  const std::vector<DropStart> starts = starts_of(drops);
  DropFindings out;
  out.drops = static_cast<int>(drops.size());
  out.left_out = out.drops - static_cast<int>(starts.size());
  const Halves halves = halves_of(starts.size(), seed);
  std::vector<const DropStart*> train, test;
  for (const std::size_t i : halves.train)
    if (train.size() < kFittedDrops) train.push_back(&starts[i]);
  for (const std::size_t i : halves.test) test.push_back(&starts[i]);
  out.tested = static_cast<int>(test.size());

  std::vector<Poses> first_exact, first_measured;
  for (const DropLaw& law : drop_laws()) {
    const Fit fit = fit_drops(train, law);
    const auto exact =
        for_each(test, [&](const DropStart& drop) { return solve(drop, law, fit.values, kExact); });
    const auto truth = for_each(test, [&](const DropStart& drop) { return measured(drop, law, fit.values); });
    out.laws.push_back({law.name, law.text, law.parameters, fit.values,
                        intervals_of_drops(train, law, fit.values, seed), differences(exact, truth, seed)});
    if (&law != &drop_laws().front()) continue;
    first_exact = exact;
    first_measured = truth;
  }

  const DropLaw& law = drop_laws().front();
  const std::vector<double>& values = out.laws.front().values;
  for (const reference::Backend* engine : engines) {
    for (const double dt : kSteps) {
      if (interrupted()) return out;
      EngineFinding finding;
      finding.engine = engine->name();
      finding.law = law.name;
      finding.dt = dt;
      const reference::Identity identity = engine->identity();
      finding.why_not = identity.available
                            ? engine->unsupported(scene_of(*test.front(), law, values), {.dt = dt})
                            : identity.reason;
      if (finding.why_not.empty()) {
        std::vector<Poses> found;
        for (const DropStart* drop : test) found.push_back(run(*engine, *drop, law, values, dt));
        for (const Poses& poses : found) finding.failed += poses ? 0 : 1;
        finding.numerical = differences(found, first_exact, seed);
        finding.measured = differences(found, first_measured, seed);
        finding.share = shares(found, first_exact, first_measured, seed);
      }
      const bool adaptive =
          finding.why_not.empty() && engine->method({.dt = dt}).scheme == reference::Scheme::Adaptive;
      if (adaptive) finding.dt = 0;
      out.engines.push_back(std::move(finding));
      if (adaptive) break;  // its steps do not depend on dt
    }
  }
  return out;
}

}  // namespace plumb::harness::reality
