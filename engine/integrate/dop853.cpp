#include "engine/integrate/dop853.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "engine/integrate/dop853_coefficients.h"

namespace plumb {

using namespace dop853;

Dop853::Dop853(std::size_t dimension)
    : rates_(kAllStages, std::vector<double>(dimension)),
      dimension_(dimension),
      at_stage_(dimension),
      increment_(dimension) {}

std::span<double> Dop853::last_rate() { return rates_[kStages]; }
std::span<const double> Dop853::last_rate() const { return rates_[kStages]; }
void Dop853::advance() {
  std::swap(rates_.front(), rates_[kStages]);
  powers_.front() = powers_[kLast];
}

double Dop853::work(double h) const {
  static_assert(kLast == kStages);
  double sum = 0;
  for (int s = 0; s < kStages; ++s) sum += kB[s] * powers_[static_cast<std::size_t>(s)];
  return sum * h;
}

/// Passes each component's weighted sum to `store`.
template <class Store>
void Dop853::weighted_sum(const double* weights, int stages, const Store& store) const {
  const double* rate[kAllStages];
  double weight[kAllStages];
  int count = 0;
  for (int j = 0; j < stages; ++j) {
    if (weights[j] == 0) continue;
    rate[count] = rates_[j].data();
    weight[count++] = weights[j];
  }
  // Works on blocks of components whose sums stay in registers; adds stages in order.
  std::size_t first = 0;
  const auto go_by = [&]<std::size_t kPart>(std::integral_constant<std::size_t, kPart>) {
    for (; first + kPart <= dimension_; first += kPart) {
      double sum[kPart] = {};
      for (int j = 0; j < count; ++j) {
        const double w = weight[j], *part = rate[j] + first;
        for (std::size_t k = 0; k < kPart; ++k) sum[k] += w * part[k];
      }
      for (std::size_t k = 0; k < kPart; ++k) store(first + k, sum[k]);
    }
  };
  go_by(std::integral_constant<std::size_t, 8>{});
  go_by(std::integral_constant<std::size_t, 4>{});
  go_by(std::integral_constant<std::size_t, 2>{});
  go_by(std::integral_constant<std::size_t, 1>{});
}

// k_s = f(t + c_s h, y + h sum_{j < s} a_sj k_j),   increment = h sum b_s k_s
void Dop853::step(Flow& flow, double time, double h, std::span<const double> y) {
  for (int s = 1; s < kStages; ++s) {
    weighted_sum(kA[s], s, [&](std::size_t i, double sum) { at_stage_[i] = y[i] + h * sum; });
    flow.rate(time + kC[s] * h, at_stage_, rates_[s]);
    powers_[static_cast<std::size_t>(s)] = flow.power();
  }
  weighted_sum(kB, kStages, [&](std::size_t i, double sum) { increment_[i] = sum * h; });
}

double Dop853::error(double h, std::span<const double> scale) const {
  double largest5 = 0, largest3 = 0;
  for (std::size_t i = 0; i < scale.size(); ++i) {
    double e5 = 0;
    for (int s = 0; s < kStages; ++s) e5 += kError5[s] * rates_[s][i];
    const double e3 = increment_[i] / h -
                      (kOrder3[0] * rates_[0][i] + kOrder3[1] * rates_[8][i] + kOrder3[2] * rates_[11][i]);
    if (!std::isfinite(e5) || !std::isfinite(e3)) return std::numeric_limits<double>::infinity();
    largest5 = std::max(largest5, std::abs(e5) / scale[i]);
    largest3 = std::max(largest3, std::abs(e3) / scale[i]);
  }
  // e5^2 / sqrt(e5^2 + e3^2/100), written so that no square overflows.
  const double ratio = largest5 > 0 ? largest3 / largest5 : 0;
  return std::abs(h) * largest5 / (ratio < 1e100 ? std::sqrt(1 + 0.01 * ratio * ratio) : 0.1 * ratio);
}

void Dop853::error_vectors(double h, std::span<double> fifth, std::span<double> third) const {
  for (std::size_t i = 0; i < dimension_; ++i) {
    double e5 = 0;
    for (int s = 0; s < kStages; ++s) e5 += kError5[s] * rates_[s][i];
    fifth[i] = h * e5;
    third[i] = increment_[i] -
               h * (kOrder3[0] * rates_[0][i] + kOrder3[1] * rates_[8][i] + kOrder3[2] * rates_[11][i]);
  }
}

double Dop853::error(std::span<const double> scale, std::span<const double> fifth,
                     std::span<const double> third) {
  double largest5 = 0, largest3 = 0;
  for (std::size_t i = 0; i < scale.size(); ++i) {
    if (!std::isfinite(fifth[i]) || !std::isfinite(third[i])) return std::numeric_limits<double>::infinity();
    largest5 = std::max(largest5, std::abs(fifth[i]) / scale[i]);
    largest3 = std::max(largest3, std::abs(third[i]) / scale[i]);
  }
  const double ratio = largest5 > 0 ? largest3 / largest5 : 0;
  return largest5 / (ratio < 1e100 ? std::sqrt(1 + 0.01 * ratio * ratio) : 0.1 * ratio);
}

double Dop853::stiffness(double h, std::span<const double> y_end, std::span<const double> scale) const {
  double rates = 0, states = 0;
  for (std::size_t i = 0; i < y_end.size(); ++i) {
    rates = std::max(rates, std::abs(rates_[kStages][i] - rates_[kStages - 1][i]) / scale[i]);
    states = std::max(states, std::abs(y_end[i] - at_stage_[i]) / scale[i]);
  }
  return states > 0 ? h * (rates / states) : 0;
}

void Dop853::polynomial(Flow& flow, double time, double h, std::span<const double> y, StepPolynomial& out) {
  for (int s = 0; s < kDenseStages; ++s) {
    const int stage = kStages + 1 + s;
    weighted_sum(kDenseA[s], stage, [&](std::size_t i, double sum) { at_stage_[i] = y[i] + h * sum; });
    flow.rate(time + kDenseC[s] * h, at_stage_, rates_[stage]);
  }
  // The publication's terms are alternating products of s and 1 - s; here 1 - s is -(s - 1).
  out.set_nodes(std::array{0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0});
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double moved = increment_[i], at_first = h * rates_.front()[i], at_last = h * rates_[kStages][i];
    out.term(1)[i] = moved;
    out.term(2)[i] = -(at_first - moved);
    out.term(3)[i] = -(2 * moved - (at_first + at_last));
  }
  constexpr double kSign[kDenseTerms] = {1, 1, -1, -1};
  for (int k = 0; k < kDenseTerms; ++k) {
    const std::span<double> term = out.term(4 + k);
    weighted_sum(kDenseD[k], kAllStages, [&](std::size_t i, double sum) { term[i] = sum * (kSign[k] * h); });
  }
}

}  // namespace plumb
