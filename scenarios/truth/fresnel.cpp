#include "scenarios/truth/fresnel.h"

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace plumb::scenarios::truth {
namespace {

constexpr Real kPi = boost::math::constants::pi<Real>();

/// Rotates a (cos, sin) by the angle of b: complex multiplication.
Vec2<Real> times(Vec2<Real> a, Vec2<Real> b) { return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x}; }

}  // namespace

Vec2<Real> fresnel(Real s) {
  using Rule = boost::math::quadrature::gauss<Real, 20>;
  Vec2<Real> sum{};
  Real from = 0;
  for (int panel = 1; from < s; ++panel) {
    const Real to = std::fmin(s, std::sqrt(static_cast<Real>(panel)));  // the phase pi u^2/2 turns by pi/2
    sum.x += Rule::integrate([](Real u) { return std::cos(kPi / 2 * u * u); }, from, to);
    sum.y += Rule::integrate([](Real u) { return std::sin(kPi / 2 * u * u); }, from, to);
    from = to;
  }
  return sum;
}

Motion thruster(Vec2<Real> acceleration, Real alpha, Real time) {
  const Real angle = alpha * time * time / 2, scale = std::sqrt(kPi / alpha);
  const Vec2<Real> k = scale * fresnel(time / scale);
  const Real half_sine = std::sin(angle / 2);
  const Vec2<Real> by_parts{std::sin(angle) / alpha, 2 * half_sine * half_sine / alpha};
  return {times(acceleration, time * k - by_parts), angle, times(acceleration, k), alpha * time};
}

}  // namespace plumb::scenarios::truth
