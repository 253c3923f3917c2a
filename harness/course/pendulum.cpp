#include "harness/course/pendulum.h"

#include <cmath>

namespace plumb::course {

std::optional<double> period_of(const std::vector<double>& zeros) {
  if (zeros.size() < 3) return std::nullopt;
  const std::size_t last = zeros.size() - 1 - (zeros.size() - 1) % 2;
  return 2 * (zeros[last] - zeros[0]) / static_cast<double>(last);
}

double period_ratio(double amplitude) {
  double a = 1, g = std::cos(amplitude / 2);
  for (int i = 0; i < 6; ++i) {
    const double mean = (a + g) / 2;
    g = std::sqrt(a * g);
    a = mean;
  }
  return 1 / a;
}

}  // namespace plumb::course
