#pragma once

#include "engine/math/vec2.h"

/// The mobility, 1 / effective mass, that a joint's spring finds along its coordinate while the joint's rigid
/// rows hold: what `hertz` and `damping_ratio` refer to, by the world and by Precise alike. A bar on a hinge
/// turns about the hinge, not about its centre. All sums are of terms that are not negative, so that nothing
/// cancels.
namespace plumb {

/// Inverse masses, 1/kg, and inverse moments of inertia, 1/(kg m^2), of the two bodies of a joint.
template <class Number>
struct PairMobility {
  Number m_a{}, i_a{}, m_b{}, i_b{};
};

/// 1/(kg m^2), of the angle between two bodies that turn about a common point, `arm_a` and `arm_b` (m) from
/// their centres of mass: with M = m_a + m_b
///   (M (i_a + i_b) + i_a i_b |r_b - r_a|^2) / (M + i_a r_a^2 + i_b r_b^2 + i_a i_b (r_a x r_b)^2 / M).
template <class Number>
Number turning_mobility(const PairMobility<Number>& p, Vec2<Number> arm_a, Vec2<Number> arm_b) {
  const Number m = p.m_a + p.m_b, turn = p.i_a + p.i_b, both = p.i_a * p.i_b;
  if (!(m > 0)) return turn;
  const Number across = cross(arm_a, arm_b);
  const Number held =
      m + p.i_a * length_squared(arm_a) + p.i_b * length_squared(arm_b) + both * across * across / m;
  return (m * turn + both * length_squared(arm_b - arm_a)) / held;
}

/// 1/kg, along an axis of unit direction `n` on which two bodies slide that do not turn relative to each
/// other; `offset`, m, leads from a's centre of mass to b's.
template <class Number>
Number sliding_mobility(const PairMobility<Number>& p, Vec2<Number> offset, Vec2<Number> n) {
  const Number m = p.m_a + p.m_b, both = p.i_a * p.i_b;
  const Number along = dot(offset, n), turn = m * (p.i_a + p.i_b);
  const Number held = turn + both * along * along;
  return held > 0 ? m * ((turn + both * length_squared(offset)) / held) : m;
}

/// 1/kg, along the first of two rows that are across each other at a point, when the second holds; from their
/// linear parts of length 1 and their angular ones, m.
template <class Number>
Number line_mobility(const PairMobility<Number>& p, Number first_a, Number first_b, Number second_a,
                     Number second_b) {
  const Number m = p.m_a + p.m_b;
  const Number second = m + p.i_a * second_a * second_a + p.i_b * second_b * second_b;
  if (!(second > 0)) return second;
  const Number across = first_a * second_b - second_a * first_b;
  const Number both = m * (m + p.i_a * (first_a * first_a + second_a * second_a) +
                           p.i_b * (first_b * first_b + second_b * second_b)) +
                      p.i_a * p.i_b * across * across;
  return both / second;
}

/// What turning together adds to the mobility of a common point, 1/(kg m^2), times p p^T with p the
/// perpendicular of the offset between the centres of mass, of two bodies that do not turn relative to each
/// other.
template <class Number>
Number common_turning(const PairMobility<Number>& p) {
  const Number turn = p.i_a + p.i_b;
  return turn > 0 ? p.i_a * p.i_b / turn : turn;
}

}  // namespace plumb
