#include "demos/core/arrow.h"

#include <cmath>
#include <cstdlib>

#include "engine/core/text.h"

namespace plumb::demos {

void draw_arrow(DebugDraw& out, Vec2d from, Vec2d to, DrawRole role) {
  const Vec2d back = 0.2 * (from - to);
  const Vec2d aside = 0.5 * perpendicular(back);
  out.segment(from, to, role);
  out.segment(to, to + back + aside, role);
  out.segment(to, to + back - aside, role);
}

std::string mass_text(double mass) {
  constexpr int kDigits = 3;
  if (!(mass > 0)) return "0 kg";
  // Dividing whole numbers gives the double nearest to the decimal.
  const int decimals = kDigits - 1 - static_cast<int>(std::floor(std::log10(mass)));
  const double power = std::pow(10, std::abs(decimals));
  const double rounded = decimals > 0 ? std::round(mass * power) / power : std::round(mass / power) * power;
  return shortest(rounded) + " kg";
}

}  // namespace plumb::demos
