#include "harness/reality/drop_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "harness/reality/drop_motion.h"
#include "harness/reality/sample.h"

namespace plumb::harness::reality {
namespace {

/// Tolerance of fitted motions: figures have three digits.
constexpr double kFitted = 1e-5;
/// Most steps, each with one derived motion a drop, and tries of all steps.
constexpr int kMostSteps = 14, kMostTries = 60;
/// Fall of the loss below which the fit is done.
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

/// Gradient of the loss, and the Gauss-Newton approximation of its second derivatives.
struct Slope {
  Values gradient, curvature;  // row after row
};

Slope slope_of(std::span<const DropStart* const> drops, const DropLaw& law, std::span<const double> values) {
  const std::size_t n = values.size();
  const std::vector<DerivedPoses> found =
      for_each(drops, [&](const DropStart& drop) { return solve_derived(drop, law, values, kFitted); });
  Slope out{Values(n, 0.0), Values(n * n, 0.0)};
  for (std::size_t time = 0; time < kTimes.size(); ++time) {
    struct Residual {
      double error = 0;
      MeasuredPose off{};
      std::vector<MeasuredPose> by;
    };
    std::vector<Residual> residuals;
    for (std::size_t i = 0; i < drops.size(); ++i) {
      const Poses truth = measured(*drops[i], law, values), rate = measured_rates(*drops[i], law, values);
      if (!found[i].poses || !truth || !rate) continue;
      const MeasuredPose &computed = (*found[i].poses)[time], &seen = (*truth)[time];
      Residual one{pose_distance(computed, seen),
                   {computed.position - seen.position, computed.angle - seen.angle},
                   {}};
      if (found[i].by[time]) {
        one.by = *found[i].by[time];
        one.by[1].position -= (*rate)[time].position, one.by[1].angle -= (*rate)[time].angle;
        one.by[2].angle -= 1;  // the offset is added to the measured angle
      }
      residuals.push_back(std::move(one));
    }
    std::sort(residuals.begin(), residuals.end(),
              [](const Residual& a, const Residual& b) { return a.error < b.error; });
    const std::size_t quarter = residuals.size() / 4, end = residuals.size() - quarter;
    double sum = 0;
    for (std::size_t i = quarter; i < end; ++i) sum += residuals[i].error;
    for (std::size_t i = quarter; i < end; ++i) {
      const Residual& r = residuals[i];
      if (r.by.empty() || !(r.error > 0)) continue;
      const double weight = 1 / (sum * r.error);
      const auto product = [](const MeasuredPose& a, const MeasuredPose& b) {
        return dot(a.position, b.position) + kAngleWeight * a.angle * b.angle;
      };
      for (std::size_t j = 0; j < n; ++j) {
        out.gradient[j] += weight * product(r.by[j], r.off);
        for (std::size_t k = 0; k < n; ++k) out.curvature[j * n + k] += weight * product(r.by[j], r.by[k]);
      }
    }
  }
  return out;
}

/// Solves (C + damping diag C) x = -g by Cholesky's method; parameters that change nothing stay.
Values damped_step(const Slope& slope, double damping) {
  const std::size_t n = slope.gradient.size();
  Values l = slope.curvature, x(n);
  for (std::size_t j = 0; j < n; ++j) {
    double& own = l[j * n + j];
    own = own > 0 ? own * (1 + damping) : 1;
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      double sum = l[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
      l[i * n + j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / l[j * n + j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = -slope.gradient[i];
    for (std::size_t k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
  }
  return x;
}

}  // namespace

Fit fit_drops(std::span<const DropStart* const> drops, const DropLaw& law) {
  Fit best;
  for (const Parameter& parameter : law.parameters) best.values.push_back(parameter.start);
  best.loss = loss_of(drops, law, best.values);
  double damping = kDamping;
  int tries = 0;
  for (int step = 0; step < kMostSteps && tries < kMostTries && !interrupted(); ++step) {
    const Slope slope = slope_of(drops, law, best.values);
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

}  // namespace plumb::harness::reality
