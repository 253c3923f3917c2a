#include "harness/reality/drop_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "harness/reality/drop_motion.h"
#include "harness/reality/linear_fit.h"

namespace plumb::harness::reality {
namespace {

/// Tolerance of fitted motions, because figures have three digits.
constexpr double kFitted = 1e-5;
/// Largest number of steps, each of which needs one motion with derivatives per drop, and of attempts in all
/// steps.
constexpr int kMostSteps = 14, kMostTries = 60;
/// Decrease of the loss below which the fit ends.
constexpr double kDone = 1e-5;
/// Levenberg's damping: at first, its growth after a step that failed, and the largest.
constexpr double kDamping = 1e-2, kHarder = 4, kHardest = 1e4;

using Values = std::vector<double>;

double loss_of(std::span<const DropStart* const> drops, const DropLaw& law, std::span<const double> values,
               const std::vector<Poses>& found) {
  double sum = 0;
  for (std::size_t time = 0; time < kTimes.size(); ++time) {
    Values errors;
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

double loss_of(std::span<const DropStart* const> drops, const DropLaw& law, std::span<const double> values) {
  return loss_of(drops, law, values,
                 for_each(drops, [&](const DropStart& drop) { return solve(drop, law, values, kFitted); }));
}

/// Residuals by time, with their derivatives.
std::vector<Residuals> residuals_of(std::span<const DropStart* const> drops, const DropLaw& law,
                                    std::span<const double> values) {
  const std::size_t n = values.size();
  const std::vector<DerivedPoses> found =
      for_each(drops, [&](const DropStart& drop) { return solve_derived(drop, law, values, kFitted); });
  std::vector<Residuals> out(kTimes.size());
  for (std::size_t i = 0; i < drops.size(); ++i) {
    const Poses truth = measured(*drops[i], law, values), rate = measured_rates(*drops[i], law, values);
    for (std::size_t time = 0; time < kTimes.size(); ++time) {
      Residual& one = out[time].emplace_back();
      one.error = std::numeric_limits<double>::infinity();
      if (!found[i].poses || !truth || !rate) continue;
      const auto components = [](const MeasuredPose& pose) {
        return std::array{pose.position.x, pose.position.y, std::sqrt(kAngleWeight) * pose.angle};
      };
      const MeasuredPose &computed = (*found[i].poses)[time], &seen = (*truth)[time];
      const auto off = components({computed.position - seen.position, computed.angle - seen.angle});
      one.off.assign(off.begin(), off.end());
      one.error = pose_distance(computed, seen);
      if (!found[i].by[time]) continue;
      std::vector<MeasuredPose> by = *found[i].by[time];
      by[1].position -= (*rate)[time].position, by[1].angle -= (*rate)[time].angle;
      by[2].angle -= 1;  // the offset is added to the measured angle
      one.by.resize(off.size() * n);
      for (std::size_t j = 0; j < n; ++j) {
        const auto column = components(by[j]);
        for (std::size_t c = 0; c < column.size(); ++c) one.by[c * n + j] = column[c];
      }
    }
  }
  return out;
}

}  // namespace

Fit fit_drops(std::span<const DropStart* const> drops, const DropLaw& law) {
  Fit best;
  for (const Parameter& parameter : law.parameters) best.values.push_back(parameter.start);
  best.loss = loss_of(drops, law, best.values);
  double damping = kDamping;
  int tries = 0;
  for (int step = 0; step < kMostSteps && tries < kMostTries && !interrupted(); ++step) {
    const Slope slope = slope_of(residuals_of(drops, law, best.values), best.values.size());
    const double before = best.loss;
    while (tries++ < kMostTries && damping <= kHardest && best.loss >= before && !interrupted()) {
      const Values change = damped_step(slope, damping);
      Fit next{best.values, 0};
      for (std::size_t j = 0; j < change.size(); ++j) {
        next.values[j] =
            std::clamp(next.values[j] + change[j], law.parameters[j].low, law.parameters[j].high);
      }
      next.loss = loss_of(drops, law, next.values);
      const bool better = next.loss < best.loss;
      damping = better ? damping / kHarder : damping * kHarder;
      if (better) best = next;
    }
    if (before - best.loss < kDone) break;
  }
  return best;
}

std::vector<Estimate> intervals_of_drops(std::span<const DropStart* const> drops, const DropLaw& law,
                                         std::span<const double> values, std::uint64_t seed) {
  return with_intervals(values, law.parameters, residuals_of(drops, law, values), seed);
}

}  // namespace plumb::harness::reality
