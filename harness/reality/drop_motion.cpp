#include "harness/reality/drop_motion.h"

#include <cmath>
#include <string>

#include "engine/driver/sensitivity.h"
#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"

namespace plumb::harness::reality {
namespace {

/// Returns the time of the first touch after the start, s, from the free-flight parabola, so it does not
/// depend on a contact law.
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

/// Positions of measured frames; each frame is later than the computed time by the fitted delay.
struct Place {
  std::size_t before = 0;
  double share = 0;  // fraction of the interval to the next frame
};
std::optional<std::array<Place, kTimes.size()>> places_of(const DropStart& start, const DropLaw& law,
                                                          std::span<const double> values) {
  const auto frames = frames_of(start, scene_of(start, law, values), values);
  std::array<Place, kTimes.size()> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double place = frames[i] + values[1] * kFramesPerSecond;
    out[i].before = static_cast<std::size_t>(std::max(0.0, std::floor(place)));
    if (out[i].before + 1 >= start.frames.size()) return {};
    out[i].share = place - static_cast<double>(out[i].before);
  }
  return out;
}

}  // namespace

std::array<int, kTimes.size()> frames_of(const DropStart& start, const Scene& scene,
                                         std::span<const double> values) {
  const double touch = first_touch(start.state, values, scene.gravity.y);
  std::array<int, kTimes.size()> out;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<int>(std::lround((touch + kTimes[i]) * kFramesPerSecond));
  return out;
}

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

DerivedPoses solve_derived(const DropStart& start, const DropLaw& law, std::span<const double> values,
                           double tolerance) {
  const Scene scene = scene_of(start, law, values);
  const auto frames = frames_of(start, scene, values);
  std::vector<std::string> numbers;
  for (const std::vector<ScaledNumber>& parameter : law.numbers) {
    for (const ScaledNumber& number : parameter) numbers.push_back(number.name);
  }
  DerivedPoses out;
  std::array<MeasuredPose, kTimes.size()> poses;
  try {
    Simulation simulation =
        compile(scene, plumb::Precise{.tolerance = tolerance, .max_dt = 1 / kFramesPerSecond},
                {.parameters = numbers});
    int now = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      simulation.step(frames[i] - now);
      now = frames[i];
      poses[i] = pose_of(simulation.state(1));
      try {
        std::vector<MeasuredPose> by(law.numbers.size());
        std::size_t index = 0;
        for (std::size_t j = 0; j < by.size(); ++j) {
          for (const ScaledNumber& number : law.numbers[j]) {
            const BodyState derivative = simulation.sensitivities(index++)[1];
            by[j].position += number.scale * derivative.position;
            by[j].angle += number.scale * derivative.angle;
          }
        }
        out.by[i] = std::move(by);
      } catch (const NotDifferentiable&) {
        out.by[i].reset();
      }
    }
    out.poses = poses;
  } catch (const Error&) {
    return {};
  }
  return out;
}

Poses measured(const DropStart& start, const DropLaw& law, std::span<const double> values) {
  const auto places = places_of(start, law, values);
  if (!places) return {};
  std::array<MeasuredPose, kTimes.size()> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto [before, share] = (*places)[i];
    const MeasuredPose &a = start.frames[before], &b = start.frames[before + 1];
    out[i] = {a.position + share * (b.position - a.position),
              a.angle + share * (b.angle - a.angle) + values[2]};
  }
  return out;
}

Poses measured_rates(const DropStart& start, const DropLaw& law, std::span<const double> values) {
  const auto places = places_of(start, law, values);
  if (!places) return {};
  std::array<MeasuredPose, kTimes.size()> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const MeasuredPose &a = start.frames[(*places)[i].before], &b = start.frames[(*places)[i].before + 1];
    out[i] = {kFramesPerSecond * (b.position - a.position), kFramesPerSecond * (b.angle - a.angle)};
  }
  return out;
}

double pose_distance(const MeasuredPose& a, const MeasuredPose& b) {
  const double turned = a.angle - b.angle;
  return std::sqrt(length_squared(a.position - b.position) + kAngleWeight * turned * turned);
}

}  // namespace plumb::harness::reality
