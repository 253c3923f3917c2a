#include "engine/integrate/dop853.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/integrate/dop853_coefficients.h"

namespace plumb {

using namespace dop853;

Dop853::Dop853(std::size_t dimension)
    : rates_(kStages, std::vector<double>(dimension)), at_stage_(dimension), increment_(dimension) {}

void Dop853::step(Flow& flow, double time, double h, std::span<const double> y) {
  // k_s = f(t + c_s h, y + h sum_{j < s} a_sj k_j),   increment = h sum b_s k_s
  const auto weighted_sum = [&](const double* weights, int stages, std::span<double> out) {
    std::fill(out.begin(), out.end(), 0.0);
    for (int j = 0; j < stages; ++j) {
      if (weights[j] == 0) continue;
      for (std::size_t i = 0; i < out.size(); ++i) out[i] += weights[j] * rates_[j][i];
    }
  };
  for (int s = 1; s < kStages; ++s) {
    weighted_sum(kA[s], s, at_stage_);
    for (std::size_t i = 0; i < y.size(); ++i) at_stage_[i] = y[i] + h * at_stage_[i];
    flow.rate(time + kC[s] * h, at_stage_, rates_[s]);
  }
  weighted_sum(kB, kStages, increment_);
  for (double& x : increment_) x *= h;
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
  const double size = std::sqrt(largest5 * largest5 + 0.01 * largest3 * largest3);
  return size == 0 ? 0 : std::abs(h) * largest5 * (largest5 / size);
}

}  // namespace plumb
