#pragma once

#include "engine/math/lanes.h"
#include "engine/math/vec2.h"

/// The mobility (1 / effective mass) along the coordinate of a joint's spring while the joint's rigid rows
/// hold. A bar on a hinge turns about the hinge, not about its centre. `hertz` and `damping_ratio` refer to
/// its value at the joint's reference (spring_stiffness.h). All sums are of non-negative terms, so that
/// nothing cancels.
namespace plumb {

/// Inverse masses, 1/kg, and inverse moments of inertia, 1/(kg m^2), of the two bodies of a joint.
template <class Number>
struct PairMobility {
  Number m_a{}, i_a{}, m_b{}, i_b{};
  friend bool operator==(const PairMobility&, const PairMobility&) = default;
};

/// Returns the mobility of the angle between two bodies that turn about a common point, 1/(kg m^2); `arm_a`
/// and `arm_b` (m) lead there from their centres of mass. With M = m_a + m_b it is
///   (M (i_a + i_b) + i_a i_b |r_b - r_a|^2) / (M + i_a r_a^2 + i_b r_b^2 + i_a i_b (r_a x r_b)^2 / M).
template <class Number>
[[gnu::always_inline]] inline Number angular_mobility(const PairMobility<Number>& p, Vec2<Number> arm_a,
                                                      Vec2<Number> arm_b) {
  const Number m = p.m_a + p.m_b, turn = p.i_a + p.i_b, both = p.i_a * p.i_b;
  return choose(
      m > Number(0),
      [&]() __attribute__((always_inline)) {
        const Number across = cross(arm_a, arm_b);
        const Number held =
            m + p.i_a * length_squared(arm_a) + p.i_b * length_squared(arm_b) + both * across * across / m;
        return Number((m * turn + both * length_squared(arm_b - arm_a)) / held);
      },
      [&]() __attribute__((always_inline)) { return turn; });
}

/// Returns the mobility along an axis of unit direction `n`, 1/kg, on which two bodies slide without relative
/// rotation; `offset`, m, leads from a's centre of mass to b's.
template <class Number>
[[gnu::always_inline]] inline Number slider_mobility(const PairMobility<Number>& p, Vec2<Number> offset,
                                                     Vec2<Number> n) {
  const Number m = p.m_a + p.m_b, both = p.i_a * p.i_b;
  const Number along = dot(offset, n), turn = m * (p.i_a + p.i_b);
  const Number held = turn + both * along * along;
  return choose(
      held > Number(0),
      [&]() __attribute__((always_inline)) {
        return Number(m * ((turn + both * length_squared(offset)) / held));
      },
      [&]() __attribute__((always_inline)) { return m; });
}

/// Returns the mobility along the first of two perpendicular rows at a point while the second holds, 1/kg;
/// from their linear parts of length 1 and their angular ones, m.
template <class Number>
[[gnu::always_inline]] inline Number line_mobility(const PairMobility<Number>& p, Number first_a,
                                                   Number first_b, Number second_a, Number second_b) {
  const Number m = p.m_a + p.m_b;
  const Number second = m + p.i_a * second_a * second_a + p.i_b * second_b * second_b;
  return choose(
      second > Number(0),
      [&]() __attribute__((always_inline)) {
        const Number across = first_a * second_b - second_a * first_b;
        const Number both = m * (m + p.i_a * (first_a * first_a + second_a * second_a) +
                                 p.i_b * (first_b * first_b + second_b * second_b)) +
                            p.i_a * p.i_b * across * across;
        return Number(both / second);
      },
      [&]() __attribute__((always_inline)) { return second; });
}

/// Returns the additional mobility of a common point due to a common rotation, 1/(kg m^2), times p p^T. The
/// two bodies do not rotate relative to each other; p is the perpendicular of the offset between their
/// centres of mass.
template <class Number>
[[gnu::always_inline]] inline Number common_rotation_mobility(const PairMobility<Number>& p) {
  const Number turn = p.i_a + p.i_b;
  return choose(
      turn > Number(0), [&]() __attribute__((always_inline)) { return Number(p.i_a * p.i_b / turn); },
      [&]() __attribute__((always_inline)) { return turn; });
}

}  // namespace plumb
