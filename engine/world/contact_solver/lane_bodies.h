#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/math/lane_rows.h"
#include "engine/world/contact_solver/solver_body.h"

namespace plumb {

/// Size of a SolverBody in units of 8 bytes, the largest scale of an x86 address. Blocks store the offsets of
/// bodies in these units.
template <class Real>
inline constexpr std::uint32_t kOffsetUnits = sizeof(SolverBody<Real>) / 8;

/// Loads the inverse masses of the bodies of a block.
template <class Number, class Real>
[[gnu::always_inline]] inline void load_masses(const SolverBody<Real>* motion,
                                               const std::uint32_t (&offset)[Number::kLanes], Number& mass,
                                               Number& inertia) {
  // The second half of a SolverBody ends with its masses.
  Number half[4];
  load_records<true>(
      [&](int i)
          __attribute__((always_inline)) { return &motion[offset[i] / kOffsetUnits<Real>].delta_position.y; },
      half);
  mass = half[2], inertia = half[3];
}

/// The bodies a, or the bodies b, of a block.
template <class Number>
struct LaneBodies {
  using Real = typename Number::Number;

  SolverBody<Real>* motion;
  const std::uint32_t (&offset)[Number::kLanes];
  const Number &inverse_mass, &inverse_inertia;
  Vec2<Number> velocity{}, delta_position{};
  Number angular_velocity = 0, delta_angle = 0;

  [[gnu::always_inline]] LaneBodies(SolverBody<Real>* bodies, const std::uint32_t (&offsets)[Number::kLanes],
                                    const Number& mass, const Number& inertia, bool read_displacement)
      : motion(bodies), offset(offsets), inverse_mass(mass), inverse_inertia(inertia) {
    static_assert(sizeof(SolverBody<Real>) == 8 * sizeof(Real) && offsetof(SolverBody<Real>, velocity) == 0 &&
                  offsetof(SolverBody<Real>, delta_angle) == 5 * sizeof(Real));
    Number first[4], last[4];
    load_records<true>(
        [&](int i) __attribute__((always_inline)) { return row(i, 0); }, first);
    velocity = {first[0], first[1]}, angular_velocity = first[2], delta_position.x = first[3];
    if (!read_displacement) return;
    load_records<true>(
        [&](int i) __attribute__((always_inline)) { return row(i, 4); }, last);
    delta_position.y = last[0], delta_angle = last[1];
  }

  [[gnu::always_inline]] void store(const Vec2<Number>& v, const Number& w) const {
    store_records<true>([&](int i) __attribute__((always_inline)) { return row(i, 0); },
                        {v.x, v.y, w, delta_position.x});
  }

 private:
  [[gnu::always_inline]] Real* row(int lane, int number) const {
    return reinterpret_cast<Real*>(reinterpret_cast<char*>(motion) + std::size_t{8} * offset[lane]) + number;
  }
};

}  // namespace plumb
