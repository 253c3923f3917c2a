#include "harness/reality/drops.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <numbers>
#include <optional>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "harness/interrupt.h"

namespace plumb::harness::reality {
namespace {

/// Tolerances: of the exact motion that engines are held against, and of fits, whose figures have three
/// digits.
constexpr double kExact = 1e-9, kFitted = 1e-5;

/// Number of drops of the training half that a law is fitted on, and of evaluations with them.
constexpr std::size_t kFittedDrops = 120;
constexpr int kEvaluations = 240;

constexpr std::array<double, 2> kSteps{1.0 / 250, 1.0 / 1000};

/// Poses of a drop at its times; nothing where it was not finished.
using Poses = std::optional<std::array<MeasuredPose, kTimes.size()>>;

/// Returns the time of the first touch after the start, s, from the parabola of the flight: it depends on
/// no law.
double first_touch(const BodyState& start, std::span<const double> values, double gravity) {
  const auto height = [&](double t) {
    const double angle = start.angle + values[2] + start.angular_velocity * t;
    return start.position.y + start.velocity.y * t + gravity * t * t / 2 -
           values[0] * (std::abs(std::cos(angle)) + std::abs(std::sin(angle)));
  };
  constexpr double kStride = 1e-4, kLongest = 0.2;
  double after = kStride;
  while (after < kLongest && height(after) > 0) after += kStride;
  double before = after - kStride;
  for (int i = 0; i < 40; ++i) {
    const double middle = (before + after) / 2;
    (height(middle) > 0 ? before : after) = middle;
  }
  return after;
}

/// Returns the frames after the start that are nearest to the times after the first touch, so that no
/// engine's state between its steps has to be interpolated.
std::array<int, kTimes.size()> frames_of(const DropStart& start, const Scene& scene,
                                         std::span<const double> values) {
  const double touch = first_touch(start.state, values, scene.gravity.y);
  std::array<int, kTimes.size()> out;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<int>(std::lround((touch + kTimes[i]) * kFramesPerSecond));
  return out;
}

MeasuredPose pose_of(const BodyState& state) { return {state.position, state.angle}; }

Poses solve(const DropStart& start, const DropLaw& law, std::span<const double> values, double tolerance) {
  const Scene scene = scene_of(start, law, values);
  const auto frames = frames_of(start, scene, values);
  std::array<MeasuredPose, kTimes.size()> out;
  try {
    Simulation simulation =
        compile(scene, plumb::Precise{.tolerance = tolerance, .max_dt = 1 / kFramesPerSecond});
    int now = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      simulation.step(frames[i] - now);
      now = frames[i];
      out[i] = pose_of(simulation.state(1));
    }
  } catch (const Error&) {
    return {};
  }
  return out;
}

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

/// Returns the measured poses, which are later than the computed ones by the delay.
Poses measured(const DropStart& start, const DropLaw& law, std::span<const double> values) {
  const auto frames = frames_of(start, scene_of(start, law, values), values);
  std::array<MeasuredPose, kTimes.size()> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double place = frames[i] + values[1] * kFramesPerSecond;
    const auto before = static_cast<std::size_t>(std::max(0.0, std::floor(place)));
    if (before + 1 >= start.frames.size()) return {};
    const double share = place - static_cast<double>(before);
    const MeasuredPose &a = start.frames[before], &b = start.frames[before + 1];
    out[i] = {a.position + share * (b.position - a.position),
              a.angle + share * (b.angle - a.angle) + values[2]};
  }
  return out;
}

double distance(const MeasuredPose& a, const MeasuredPose& b) {
  return std::sqrt(length_squared(a.position - b.position));
}

/// Returns the difference of two poses as the norm of the kinetic energy weighs it, m: with the inertia of a
/// uniform square of 60 mm.
double pose_distance(const MeasuredPose& a, const MeasuredPose& b) {
  constexpr double kUniform = 0.06 * 0.06 / 6;
  const double turned = a.angle - b.angle;
  return std::sqrt(length_squared(a.position - b.position) + kUniform * turned * turned);
}

/// Computes `of` for all drops on two threads.
template <class Of>
std::vector<Poses> for_each(std::span<const DropStart* const> drops, const Of& of) {
  std::vector<Poses> out(drops.size());
  const auto part = [&](std::size_t first) {
    for (std::size_t i = first; i < drops.size() && !interrupted(); i += 2) out[i] = of(*drops[i]);
  };
  auto other = std::async(std::launch::async, part, std::size_t{1});
  part(0);
  other.get();
  return out;
}

Differences differences(const std::vector<Poses>& a, const std::vector<Poses>& b, std::uint64_t seed) {
  Differences out;
  for (std::size_t time = 0; time < kTimes.size(); ++time) {
    std::vector<double> lengths, angles;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (!a[i] || !b[i]) continue;
      lengths.push_back(distance((*a[i])[time], (*b[i])[time]));
      angles.push_back(std::abs((*a[i])[time].angle - (*b[i])[time].angle));
    }
    out.position[time] = estimate(lengths, 0.5, seed);
    out.ninetieth[time] = quantile(lengths, 0.9);
    out.angle[time] = estimate(angles, 0.5, seed);
  }
  return out;
}

/// Returns the mean over the times of the logarithm of the middle half's mean error, so that each time has
/// the same weight although errors grow.
double loss(std::span<const DropStart* const> drops, const DropLaw& law, std::span<const double> values) {
  const std::vector<Poses> found =
      for_each(drops, [&](const DropStart& drop) { return solve(drop, law, values, kFitted); });
  double sum = 0;
  for (std::size_t time = 0; time < kTimes.size(); ++time) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < drops.size(); ++i) {
      const Poses truth = measured(*drops[i], law, values);
      const bool both = found[i] && truth;
      errors.push_back(both ? pose_distance((*found[i])[time], (*truth)[time])
                            : std::numeric_limits<double>::infinity());
    }
    sum += std::log(middle_mean(std::move(errors)));
  }
  return sum / static_cast<double>(kTimes.size());
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
    const Fit fit = minimise(law.parameters, kEvaluations,
                             [&](std::span<const double> values) { return loss(train, law, values); });
    const auto exact =
        for_each(test, [&](const DropStart& drop) { return solve(drop, law, fit.values, kExact); });
    const auto truth = for_each(test, [&](const DropStart& drop) { return measured(drop, law, fit.values); });
    out.laws.push_back({law.name, law.text, law.parameters, fit.values, differences(exact, truth, seed)});
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
