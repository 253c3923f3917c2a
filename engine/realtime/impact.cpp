#include "engine/realtime/impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {

template <class Real>
void solve_impact(const Impact<Real>& impact, Real (&impulse)[4]) {
  constexpr int kMostSweeps = 5000;  // half of the flat landings need 20, one in a thousand more than 1000
  const int size = 2 * impact.points;
  Real velocity[4], bound[4];
  Real largest = 0;
  for (int i = 0; i < size; ++i) {
    impulse[i] = 0;
    velocity[i] = impact.velocity[i];
    bound[i] = i % 2 == 0 ? std::max(Real{0}, -impact.restitution * impact.velocity[i]) : Real{0};
    largest = std::max(largest, std::abs(velocity[i]));
  }
  const auto change_by = [&](int j, Real change) {
    impulse[j] += change;
    for (int i = 0; i < size; ++i) velocity[i] += impact.response[i][j] * change;
  };
  const Real enough = 16 * largest * std::numeric_limits<Real>::epsilon();
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    Real moved = 0;
    for (int i = 0; i < size; ++i) {
      if (!(impact.response[i][i] > 0)) continue;
      const Real wanted = impulse[i] - (velocity[i] - bound[i]) / impact.response[i][i];
      const Real limit = i % 2 == 0 ? Real{0} : impact.friction * impulse[i - 1];
      const Real next = i % 2 == 0 ? std::max(wanted, Real{0}) : std::clamp(wanted, -limit, limit);
      moved = std::max(moved, std::abs(next - impulse[i]) * impact.response[i][i]);
      change_by(i, next - impulse[i]);
    }
    if (moved <= enough) break;
  }
}

template void solve_impact(const Impact<float>&, float (&)[4]);
template void solve_impact(const Impact<double>&, double (&)[4]);

}  // namespace plumb
