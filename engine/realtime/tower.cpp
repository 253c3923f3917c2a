#include "engine/realtime/tower.h"

#include <algorithm>
#include <cmath>

namespace plumb {
namespace {

/// See `sway_of`.
constexpr double kSwayOfTwo = 0.5;

/// Maximum separation of touching shapes, as a fraction of the contact's `reach` (of the smaller shape).
constexpr double kTouches = 0.01;

}  // namespace

template <class Real>
Tower TowerFinder<Real>::tallest(std::span<const Contact<Real>> contacts, std::span<const char> dynamic,
                                 std::span<const Real> width, Vec2<Real> up) {
  of_.assign(dynamic.size(), {});
  for (const Contact<Real>& contact : contacts) {
    if (contact.count == 0 || contact.points[0].separation > Real(kTouches) * contact.reach) continue;
    const Real upward = dot(contact.normal, up);
    ++of_[contact.a].touching, ++of_[contact.b].touching;
    const int lower = upward > 0 ? contact.a : contact.b, upper = upward > 0 ? contact.b : contact.a;
    if (std::abs(upward) > Real(0.5)) of_[upper].below = lower, of_[lower].above = upper;
  }
  Tower tallest;
  for (int foot = 0; foot < static_cast<int>(of_.size()); ++foot) {
    const int ground = of_[foot].below;
    if (ground < 0 || dynamic[ground] || !dynamic[foot]) continue;
    int levels = 0, top = foot;
    Real widest = 0;
    for (int body = foot; body >= 0 && of_[body].touching == 1 + (of_[body].above >= 0);
         body = of_[body].above)
      ++levels, top = body, widest = std::max(widest, width[body]);
    if (levels > tallest.levels) tallest = {levels, top, static_cast<double>(widest)};
  }
  return tallest;
}

double sway_of(int levels, double fall, int sweeps) {
  const double height = levels;
  return kSwayOfTwo * fall * height * height * std::sqrt(height / sweeps);
}

double sway_by_rounding(int levels, double epsilon) {
  const double height = levels;
  return 0.5 * epsilon * height * height * std::sqrt(height);
}

template class TowerFinder<float>;
template class TowerFinder<double>;

}  // namespace plumb
