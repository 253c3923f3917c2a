#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/math/lane_rows.h"
#include "engine/world/contact_solver/body_motion.h"

namespace plumb {

/// Units of 8 bytes of a BodyMotion: the largest scale of an x86 address. Blocks store the positions of
/// bodies in these units.
template <class Real>
inline constexpr std::uint32_t kPlaceUnits = sizeof(BodyMotion<Real>) / 8;

/// Loads the inverse masses of the bodies of a block.
template <class Number, class Real>
[[gnu::always_inline]] inline void load_masses(const BodyMotion<Real>* motion,
                                               const std::uint32_t (&place)[Number::kLanes], Number& mass,
                                               Number& inertia) {
  // The second half of a BodyMotion ends with its masses.
  Number half[4];
  load_records<true>(
      [&](int i) __attribute__((always_inline)) { return &motion[place[i] / kPlaceUnits<Real>].moved.y; },
      half);
  mass = half[2], inertia = half[3];
}

/// The bodies a, or the bodies b, of a block.
template <class Number>
struct LaneBodies {
  using Real = typename Number::Number;

  BodyMotion<Real>* motion;
  const std::uint32_t (&place)[Number::kLanes];
  const Number &inverse_mass, &inverse_inertia;
  Vec2<Number> velocity{}, moved{};
  Number angular_velocity = 0, turned = 0;

  [[gnu::always_inline]] LaneBodies(BodyMotion<Real>* bodies, const std::uint32_t (&places)[Number::kLanes],
                                    const Number& mass, const Number& inertia, bool moves)
      : motion(bodies), place(places), inverse_mass(mass), inverse_inertia(inertia) {
    static_assert(sizeof(BodyMotion<Real>) == 8 * sizeof(Real) && offsetof(BodyMotion<Real>, velocity) == 0 &&
                  offsetof(BodyMotion<Real>, turned) == 5 * sizeof(Real));
    Number first[4], last[4];
    load_records<true>(
        [&](int i) __attribute__((always_inline)) { return row(i, 0); }, first);
    velocity = {first[0], first[1]}, angular_velocity = first[2], moved.x = first[3];
    if (!moves) return;
    load_records<true>(
        [&](int i) __attribute__((always_inline)) { return row(i, 4); }, last);
    moved.y = last[0], turned = last[1];
  }

  [[gnu::always_inline]] void store(const Vec2<Number>& v, const Number& w) const {
    store_records<true>([&](int i) __attribute__((always_inline)) { return row(i, 0); },
                        {v.x, v.y, w, moved.x});
  }

 private:
  [[gnu::always_inline]] Real* row(int lane, int number) const {
    return reinterpret_cast<Real*>(reinterpret_cast<char*>(motion) + std::size_t{8} * place[lane]) + number;
  }
};

}  // namespace plumb
