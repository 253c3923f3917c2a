#include "harness/course/factors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

namespace plumb::course {

std::string factor_text(double factor, double dt) {
  const auto is = [&](double other) { return std::abs(factor / other - 1) < 0.01; };
  if (is(dt)) return "dt";
  return is(1 / dt) ? "1/dt" : fmt::format("{:.3g}", factor);
}

double plain_factor(double factor, double dt) {
  constexpr double kNear = 0.003, kDegrees = 180 / std::numbers::pi;
  std::vector<double> plain{0, dt, 1 / dt, kDegrees, 1 / kDegrees};
  for (int i = 1; i <= 12; ++i) plain.insert(plain.end(), {i * 1.0, 1.0 / i, -i * 1.0, -1.0 / i});
  for (const double each : plain)
    if (std::abs(factor - each) <= kNear * std::max(std::abs(each), kNear)) return each;
  return factor;
}

}  // namespace plumb::course
