#include "scenarios/truth/oscillator.h"

#include <cmath>
#include <numbers>

namespace plumb::scenarios::truth {

Swing damped_swing(Swing start, Real w, Real zeta, Real time) {
  const Real square = 1 - zeta * zeta, d = w * std::sqrt(std::fabs(square));
  const Real c = square < 0 ? std::cosh(d * time) : std::cos(d * time);
  const Real s = square == 0 ? time : (square < 0 ? std::sinh(d * time) : std::sin(d * time)) / d;
  const Real decay = std::exp(-zeta * w * time);
  const Real slope = start.rate + zeta * w * start.place;
  // x' from the product rule; c' = -(w^2 - zeta^2 w^2) s and s' = c in all three cases.
  const Real place = start.place * c + slope * s;
  const Real rate = slope * c - start.place * w * w * square * s - zeta * w * place;
  return {decay * place, decay * rate};
}

Swing chain_swing(int count, int j, Real w, Real pulled, Real time) {
  const Real unit = std::numbers::pi_v<Real> / (count + 1);
  Swing sum;
  for (int k = 1; k <= count; ++k) {
    const Real size = 2 * pulled / (count + 1) * std::sin(k * unit) * std::sin(j * k * unit);
    const Real rate = 2 * w * std::sin(k * unit / 2);
    sum.place += size * std::cos(rate * time);
    sum.rate -= size * rate * std::sin(rate * time);
  }
  return sum;
}

}  // namespace plumb::scenarios::truth
