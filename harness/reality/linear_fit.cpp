#include "harness/reality/linear_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "harness/reality/parallel.h"

namespace plumb::harness::reality {
namespace {

constexpr std::size_t kRefits = 200;

/// Largest number of steps of a refit. Each solves a least-squares problem, weighted by the errors of the
/// step before.
constexpr int kMostSteps = 60;
/// Change of the loss below which a refit ends.
constexpr double kDone = 1e-7;

using Values = std::vector<double>;

/// Returns the indices of the middle half of the errors.
std::vector<std::size_t> middle_half(const Residuals& residuals) {
  std::vector<std::size_t> order(residuals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return residuals[a].error < residuals[b].error; });
  const auto quarter = static_cast<std::ptrdiff_t>(residuals.size() / 4);
  return {order.begin() + quarter, order.end() - quarter};
}

double length(const Values& values) {
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0));
}

double loss_of(std::span<const Residuals> times) {
  double sum = 0;
  for (const Residuals& residuals : times) {
    Values errors;
    for (const Residual& residual : residuals) errors.push_back(residual.error);
    sum += std::log(middle_mean(std::move(errors)));
  }
  return sum / static_cast<double>(times.size());
}

/// Returns the residuals after a change of the parameters.
std::vector<Residuals> changed(std::vector<Residuals> times, std::span<const double> change) {
  for (Residuals& residuals : times) {
    for (Residual& residual : residuals) {
      if (residual.by.empty()) continue;
      for (std::size_t c = 0; c < residual.off.size(); ++c)
        for (std::size_t j = 0; j < change.size(); ++j)
          residual.off[c] += residual.by[c * change.size() + j] * change[j];
      residual.error = length(residual.off);
    }
  }
  return times;
}

/// Returns the change of the parameters that has the least loss.
Values refit(const std::vector<Residuals>& times, std::size_t parameters) {
  Values best(parameters, 0.0), change = best;
  double least = loss_of(times), last = least;
  std::vector<Residuals> now = times;
  for (int step = 0; step < kMostSteps; ++step) {
    const Values more = damped_step(slope_of(now, parameters), 0);
    for (std::size_t j = 0; j < parameters; ++j) change[j] += more[j];
    now = changed(times, change);
    const double loss = loss_of(now);
    if (loss < least) least = loss, best = change;
    if (std::abs(loss - last) < kDone) break;
    last = loss;
  }
  return best;
}

}  // namespace

Slope slope_of(std::span<const Residuals> times, std::size_t parameters) {
  Slope out{Values(parameters, 0.0), Values(parameters * parameters, 0.0)};
  for (const Residuals& residuals : times) {
    const std::vector<std::size_t> middle = middle_half(residuals);
    double sum = 0;
    for (const std::size_t i : middle) sum += residuals[i].error;
    for (const std::size_t i : middle) {
      const Residual& r = residuals[i];
      if (r.by.empty() || !(r.error > 0)) continue;
      const double weight = 1 / (sum * r.error);
      for (std::size_t c = 0; c < r.off.size(); ++c) {
        const double* by = &r.by[c * parameters];
        for (std::size_t j = 0; j < parameters; ++j) {
          out.gradient[j] += weight * by[j] * r.off[c];
          for (std::size_t k = 0; k < parameters; ++k)
            out.curvature[j * parameters + k] += weight * by[j] * by[k];
        }
      }
    }
  }
  return out;
}

std::vector<double> damped_step(const Slope& slope, double damping) {
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

std::vector<Estimate> with_intervals(std::span<const double> values, std::span<const Parameter> parameters,
                                     std::span<const Residuals> times, std::uint64_t seed) {
  const std::vector<Values> changes = in_parallel(kRefits, [&](std::size_t number) {
    const std::vector<std::size_t> drawn = resample(times.front().size(), seed, number);
    std::vector<Residuals> sample(times.size());
    for (std::size_t t = 0; t < times.size(); ++t)
      for (const std::size_t i : drawn) sample[t].push_back(times[t][i]);
    return refit(sample, values.size());
  });
  std::vector<Estimate> out;
  for (std::size_t j = 0; j < values.size(); ++j) {
    Values found;
    for (const Values& change : changes) {
      if (change.empty()) continue;  // after an interrupt
      found.push_back(std::clamp(values[j] + change[j], parameters[j].low, parameters[j].high));
    }
    out.push_back(interval_of(values[j], found));
  }
  return out;
}

}  // namespace plumb::harness::reality
