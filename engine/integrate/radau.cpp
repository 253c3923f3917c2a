#include "engine/integrate/radau.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/integrate/radau_coefficients.h"

namespace plumb {

using namespace radau;

Radau::Radau(std::size_t dimension)
    : n_(dimension),
      increment_(dimension),
      at_stage_(dimension),
      estimate_(dimension),
      rates_(kStages * dimension),
      change_(kStages * dimension) {}

/// Extrapolates the last step's stage rates (a polynomial of degree 4) to the new stages.
void Radau::guess(double h, std::span<const double> first_rate) {
  if (last_h_ == 0) {
    for (int s = 0; s < kStages; ++s) std::copy(first_rate.begin(), first_rate.end(), &rates_[s * n_]);
    return;
  }
  std::array<std::array<double, kStages>, kStages> weight;  // [new stage][old stage], of its rate
  for (int s = 0; s < kStages; ++s) {
    const double at = 1 + kC[s] * (h / last_h_);
    for (int j = 0; j < kStages; ++j) {
      double w = 1;
      for (int k = 0; k < kStages; ++k) w *= k == j ? 1 : (at - kC[k]) / (kC[j] - kC[k]);
      weight[s][j] = w;
    }
  }
  for (std::size_t i = 0; i < n_; ++i) {
    std::array<double, kStages> old;
    for (int j = 0; j < kStages; ++j) old[j] = rates_[j * n_ + i];
    for (int s = 0; s < kStages; ++s) {
      double sum = 0;
      for (int j = 0; j < kStages; ++j) sum += weight[s][j] * old[j];
      rates_[s * n_ + i] = sum;
    }
  }
}

// Solves k_i = f(t + c_i h, y + h sum_j a_ij k_j) for the k by Newton's method.
bool Radau::step(StiffFlow& flow, double time, double h, std::span<const double> y,
                 std::span<const double> first_rate, std::span<const double> scale) {
  constexpr int kMostIterations = 12;
  // Errors as fractions of the scale: the iteration ends at kSmall; if it stagnates before, at most kStagnant
  // is accepted.
  constexpr double kSmall = 1e-2, kStagnant = 0.3;
  constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
  guess(h, first_rate);
  last_h_ = 0;
  double before = 0;
  if (!flow.factor(StiffFlow::Use::Stages, {&kA[0][0], kStages * kStages}, kStages, h)) return false;
  for (iterations_ = 1; iterations_ <= kMostIterations; ++iterations_) {
    for (int s = 0; s < kStages; ++s) {
      for (std::size_t i = 0; i < n_; ++i) {
        double sum = 0;
        for (int j = 0; j < kStages; ++j) sum += kA[s][j] * rates_[j * n_ + i];
        at_stage_[i] = y[i] + h * sum;
      }
      const std::span<double> out(&change_[s * n_], n_);
      flow.rate(time + kC[s] * h, at_stage_, out);
      for (std::size_t i = 0; i < n_; ++i) out[i] -= rates_[s * n_ + i];
    }
    flow.solve(StiffFlow::Use::Stages, change_);
    double size = 0;
    bool rounding = true;
    for (std::size_t k = 0; k < change_.size(); ++k) {
      rates_[k] += change_[k];
      const double moved = std::abs(h * change_[k]);
      if (!std::isfinite(moved)) return false;
      size = std::max(size, moved / scale[k % n_]);
      rounding = rounding && moved <= kRounding * std::abs(y[k % n_]);
    }
    const double contraction = iterations_ > 1 ? size / before : 0.5;
    if (rounding || (contraction < 1 && size * contraction / (1 - contraction) <= kSmall)) break;
    if (iterations_ > 2 && contraction >= 1) {
      if (size > kStagnant) return false;
      break;  // stagnates at rounding
    }
    before = size;
  }
  if (iterations_ > kMostIterations) return false;
  for (std::size_t i = 0; i < n_; ++i) {
    double sum = 0;
    for (int j = 0; j < kStages; ++j) sum += kA[kStages - 1][j] * rates_[j * n_ + i];
    increment_[i] = h * sum;
  }
  last_h_ = h;
  return true;
}

double Radau::error(StiffFlow& flow, double time, double h, std::span<const double> y,
                    std::span<const double> first_rate, std::span<const double> scale, bool again) {
  const auto difference = [&](std::span<const double> rate) {
    for (std::size_t i = 0; i < n_; ++i) {
      double sum = kGamma * rate[i];
      for (int j = 0; j < kStages; ++j) sum += (kEstimateB[j] - kA[kStages - 1][j]) * rates_[j * n_ + i];
      estimate_[i] = h * sum;
    }
    flow.solve(StiffFlow::Use::Estimate, estimate_);
  };
  const auto size = [&] {
    double largest = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      if (!std::isfinite(estimate_[i])) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, std::abs(estimate_[i]) / scale[i]);
    }
    return largest;
  };
  if (!flow.factor(StiffFlow::Use::Estimate, {&kGamma, 1}, 1, h))
    return std::numeric_limits<double>::infinity();
  difference(first_rate);
  const double first = size();
  if (first <= 1 || !again || !std::isfinite(first)) return first;
  for (std::size_t i = 0; i < n_; ++i) at_stage_[i] = y[i] + estimate_[i];
  flow.rate(time, at_stage_, estimate_);
  std::swap(at_stage_, estimate_);
  difference(at_stage_);
  return size();
}

void Radau::set_memory(double last_step, std::span<const double> rates) {
  last_h_ = last_step;
  std::copy(rates.begin(), rates.end(), rates_.begin());
}

// Interpolates the start and the stages by divided differences.
void Radau::polynomial(StepPolynomial& out) const {
  std::array<double, kStages> nodes{};
  for (int k = 1; k < kStages; ++k) nodes[k] = kC[k - 1];
  out.set_nodes(nodes);
  for (std::size_t i = 0; i < n_; ++i) {
    std::array<double, kStages + 1> value{}, at{};  // by node: the start and the stages
    for (int s = 0; s < kStages; ++s) {
      double sum = 0;
      for (int j = 0; j < kStages; ++j) sum += kA[s][j] * rates_[j * n_ + i];
      value[s + 1] = last_h_ * sum;
      at[s + 1] = kC[s];
    }
    for (int level = 1; level <= kStages; ++level) {
      for (int k = kStages; k >= level; --k) value[k] = (value[k] - value[k - 1]) / (at[k] - at[k - level]);
      out.term(level)[i] = value[level];
    }
  }
}

}  // namespace plumb
