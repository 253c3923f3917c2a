#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "engine/math/lane_rows.h"
#include "engine/world/contact_solver/body_motion.h"
#include "engine/world/contact_solver/contact_constraint.h"

namespace plumb {

/// Contacts of one colour side by side, a lane each, for the time of a step: what the passes need of a
/// ContactConstraint, in rows of one number of each, and the inverse masses of their bodies. All have the
/// same number of points and hardness, all or none have rolling resistance, and the same sides give way.
/// Lanes that are left over repeat the last contact: they come to the same results, which are stored twice.
template <class Number>
struct ContactBlock {
  using Real = typename Number::Number;
  using Constraint = ContactConstraint<Real>;
  static constexpr int kLanes = Number::kLanes;

  /// Of the bodies, in units of 8 bytes from the first BodyMotion on: an address's largest scale.
  std::uint32_t place_a[kLanes], place_b[kLanes];
  Number inverse_mass_a, inverse_inertia_a, inverse_mass_b, inverse_inertia_b;
  Vec2<Number> normal;
  Number arm_a[2], arm_tangent_a, arm_b[2], arm_tangent_b;
  Number separation[2], now[2], normal_impulse[2], expected_impulse[2], tangent_impulse;
  Number mass[2], inverse_pp, inverse_pq, inverse_qq, between, tangent_mass;
  Number friction, push_speed, surface_speed;
  ContactHardness hardness;
  std::uint8_t count;             ///< points
  std::uint8_t used;              ///< lanes
  bool gives_way_a, gives_way_b;  ///< impulses change the velocities of the bodies a, b
  bool watched;                   ///< at least one is
  bool rolls;                     ///< all have rolling resistance
  Number rolling_arm, rolling_impulse, peak_impulse[2];
  Constraint* contact[kLanes];

  /// Calls `visit(row, number)` for what lanes and constraints have in common.
  template <class Visit>
  void for_each_row(const Constraint& c, const Visit& visit) {
    visit(normal.x, c.normal.x), visit(normal.y, c.normal.y);
    visit(arm_tangent_a, c.arm_tangent_a), visit(arm_tangent_b, c.arm_tangent_b);
    for (int i = 0; i < 2; ++i) {
      visit(arm_a[i], c.arm_a[i]), visit(arm_b[i], c.arm_b[i]), visit(mass[i], c.mass[i]);
      visit(separation[i], c.separation[i]), visit(now[i], c.now[i]);
      visit(normal_impulse[i], c.normal_impulse[i]), visit(expected_impulse[i], c.expected_impulse[i]);
    }
    visit(tangent_impulse, c.tangent_impulse), visit(tangent_mass, c.tangent_mass);
    visit(inverse_pp, c.inverse_pp), visit(inverse_pq, c.inverse_pq), visit(inverse_qq, c.inverse_qq);
    visit(between, c.between), visit(friction, c.friction);
    visit(push_speed, c.push_speed), visit(surface_speed, c.surface_speed);
  }

  /// Gathers `count` contacts.
  void gather(Constraint* const* contacts, int lanes, const BodyMotion<Real>* motion) {
    const Constraint& first = *contacts[0];
    hardness = first.hardness, count = first.count, rolls = first.rolling_arm > 0, watched = false;
    gives_way_a = gives_way(motion[first.body_a]), gives_way_b = gives_way(motion[first.body_b]);
    used = static_cast<std::uint8_t>(lanes);
    for (int lane = 0; lane < kLanes; ++lane) put(lane, *contacts[lane < lanes ? lane : lanes - 1], motion);
  }
  void put(int lane, Constraint& c, const BodyMotion<Real>* motion) {
    const auto set = [lane](Number& row, Real value) {
      std::memcpy(reinterpret_cast<char*>(&row) + lane * sizeof(Real), &value, sizeof(Real));
    };
    constexpr std::uint32_t kUnits = sizeof(BodyMotion<Real>) / 8;
    const BodyMotion<Real>&a = motion[c.body_a], &b = motion[c.body_b];
    place_a[lane] = kUnits * static_cast<std::uint32_t>(c.body_a);
    place_b[lane] = kUnits * static_cast<std::uint32_t>(c.body_b);
    set(inverse_mass_a, a.inverse_mass), set(inverse_inertia_a, a.inverse_inertia);
    set(inverse_mass_b, b.inverse_mass), set(inverse_inertia_b, b.inverse_inertia);
    for_each_row(c, set);
    contact[lane] = &c;
    if (c.watched) {
      if (!watched) peak_impulse[0] = peak_impulse[1] = 0;
      watched = true;
      set(peak_impulse[0], c.peak_impulse[0]), set(peak_impulse[1], c.peak_impulse[1]);
    }
    if (rolls) set(rolling_arm, c.rolling_arm), set(rolling_impulse, c.rolling_impulse);
  }

  /// Writes the results back to the contacts.
  void scatter() const {
    for (int lane = 0; lane < used; ++lane) {
      const auto get = [lane](Real& value, const Number& row) {
        std::memcpy(&value, reinterpret_cast<const char*>(&row) + lane * sizeof(Real), sizeof(Real));
      };
      Constraint& c = *contact[lane];
      for (int i = 0; i < 2; ++i) {
        get(c.now[i], now[i]), get(c.normal_impulse[i], normal_impulse[i]);
        get(c.expected_impulse[i], expected_impulse[i]);
        if (c.watched) get(c.peak_impulse[i], peak_impulse[i]);
      }
      get(c.tangent_impulse, tangent_impulse);
      if (rolls) get(c.rolling_impulse, rolling_impulse);
    }
  }
};

template <class Real>
bool rolls(const ContactConstraint<Real>& c) {
  return c.rolling_arm > 0;
}
template <class Number>
[[gnu::always_inline]] inline bool rolls(const ContactBlock<Number>& block) {
  return block.rolls;
}

}  // namespace plumb
