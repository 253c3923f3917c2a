#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "engine/math/lane_rows.h"
#include "engine/world/contact_solver/contact_constraint.h"
#include "engine/world/contact_solver/lane_bodies.h"
#include "engine/world/contact_solver/solver_body.h"

namespace plumb {

/// Contacts of one colour in SIMD lanes, for one step: the members of ContactConstraint that the passes need,
/// each as a row with one number per contact, and the inverse masses of the bodies. All contacts have the
/// same number of points, hardness and dynamic sides; all or none have rolling resistance. Unused lanes
/// repeat the last contact: they get the same results, which are stored twice.
template <class Number>
struct ContactBlock {
  using Real = typename Number::Number;
  using Constraint = ContactConstraint<Real>;
  static constexpr int kLanes = Number::kLanes;

  /// Offsets of the bodies in the array of solver bodies, in kOffsetUnits.
  std::uint32_t offset_a[kLanes], offset_b[kLanes];
  Number inverse_mass_a, inverse_inertia_a, inverse_mass_b, inverse_inertia_b;

  // In the order of ContactConstraint, up to its flags.
  Vec2<Number> normal;
  Number arm_a[2], arm_tangent_a, arm_b[2], arm_tangent_b;
  Number separation[2], current_separation[2], normal_impulse[2], load_estimate[2], tangent_impulse;
  Number mass[2], inverse_pp, inverse_pq, inverse_qq, k_pq, tangent_mass;
  Number friction, depenetration_speed, surface_speed, flags;

  ContactHardness hardness;
  std::uint8_t count;               ///< points
  bool is_dynamic_a, is_dynamic_b;  ///< impulses change the velocities of the bodies a, b
  ImpactTracking tracking;          ///< the maximum of all contacts
  bool bounces;                     ///< at least one has restitution
  bool rolls;                       ///< all have rolling resistance
  bool plain;                       ///< none is tracked, driven or has rolling resistance
  Number rolling_arm, rolling_impulse, max_normal_impulse[2], step_impulse;
  Constraint* contact[kLanes];
};

template <class Real>
bool rolls(const ContactConstraint<Real>& c) {
  return c.rolling_arm > 0;
}
template <class Number>
[[gnu::always_inline]] inline bool rolls(const ContactBlock<Number>& block) {
  return block.rolls;
}

/// Returns true if a contact is neither tracked nor driven, and has no rolling resistance: one test for what
/// most contacts do not need.
template <class Real>
bool is_plain(const ContactConstraint<Real>& c) {
  return c.tracking == ImpactTracking::Off && !is_driven(c) && !rolls(c);
}
template <class Number>
[[gnu::always_inline]] inline bool is_plain(const ContactBlock<Number>& block) {
  return block.plain;
}

/// Copies four members of each contact of a block, beginning with a given one, to or from the block's rows.
template <class Number>
struct ContactRows {
  using Real = typename Number::Number;
  ContactBlock<Number>& block;

  [[gnu::always_inline]] void load(std::size_t constraint_offset, std::size_t block_offset) const {
    Number rows[4];
    load_records<false>(
        [&](int i) __attribute__((always_inline)) { return number(i, constraint_offset); }, rows);
    for (int k = 0; k < 4; ++k) row(block_offset)[k] = rows[k];
  }
  [[gnu::always_inline]] void store(std::size_t constraint_offset, std::size_t block_offset) const {
    const Number* from = row(block_offset);
    store_records<false>([&](int i) __attribute__((always_inline)) { return number(i, constraint_offset); },
                         {from[0], from[1], from[2], from[3]});
  }

 private:
  [[gnu::always_inline]] Real* number(int lane, std::size_t offset) const {
    return reinterpret_cast<Real*>(reinterpret_cast<char*>(block.contact[lane]) + offset);
  }
  [[gnu::always_inline]] Number* row(std::size_t offset) const {
    return reinterpret_cast<Number*>(reinterpret_cast<char*>(&block) + offset);
  }
};

/// Reads the rolling impulses, largest impulses and sums of the step so far of a block's contacts, if it
/// needs them.
template <class Number>
[[gnu::always_inline]] inline void gather_records(const ContactRows<Number>& rows) {
  using Block = ContactBlock<Number>;
  using Real = typename Number::Number;
  using Constraint = ContactConstraint<Real>;
  static_assert(offsetof(Constraint, max_normal_impulse) ==
                    offsetof(Constraint, rolling_arm) + 2 * sizeof(Real) &&
                offsetof(Block, max_normal_impulse) == offsetof(Block, rolling_arm) + 2 * sizeof(Number));
  Block& block = rows.block;
  if (block.tracking != ImpactTracking::Off || block.rolls)
    rows.load(offsetof(Constraint, rolling_arm), offsetof(Block, rolling_arm));
  if (block.tracking == ImpactTracking::Off) return;
  Real sums[Block::kLanes];
  for (int i = 0; i < Block::kLanes; ++i) sums[i] = block.contact[i]->step_impulse;
  block.step_impulse = Number::load(sums);
}

/// Fills a block from its contacts, which are all of one kind.
template <class Number, class Real>
[[gnu::always_inline]] inline void gather(ContactBlock<Number>& block, const SolverBody<Real>* motion) {
  using Block = ContactBlock<Number>;
  using Constraint = ContactConstraint<Real>;
  constexpr std::size_t kFirst = offsetof(Constraint, normal), kFirstRow = offsetof(Block, normal);
  constexpr int kRows = 28;
  static_assert(offsetof(Constraint, hardness) == kFirst + (kRows - 1) * sizeof(Real) &&
                offsetof(Block, flags) == kFirstRow + (kRows - 1) * sizeof(Number));
  static_assert(offsetof(Constraint, current_separation) - kFirst == 10 * sizeof(Real) &&
                offsetof(Block, current_separation) - kFirstRow == 10 * sizeof(Number));
  static_assert(offsetof(Constraint, mass) - kFirst == 17 * sizeof(Real) &&
                offsetof(Block, mass) - kFirstRow == 17 * sizeof(Number));
  const ContactRows<Number> rows{block};
  for (int k = 0; k < kRows; k += 4) rows.load(kFirst + k * sizeof(Real), kFirstRow + k * sizeof(Number));

  block.tracking = ImpactTracking::Off, block.bounces = false;
  for (int i = 0; i < Block::kLanes; ++i) {
    const Constraint& c = *block.contact[i];
    block.offset_a[i] = kOffsetUnits<Real> * static_cast<std::uint32_t>(c.body_a);
    block.offset_b[i] = kOffsetUnits<Real> * static_cast<std::uint32_t>(c.body_b);
    block.tracking = std::max(block.tracking, c.tracking);
    block.bounces |= c.restitution > 0;
  }
  load_masses(motion, block.offset_a, block.inverse_mass_a, block.inverse_inertia_a);
  load_masses(motion, block.offset_b, block.inverse_mass_b, block.inverse_inertia_b);

  const Constraint& first = *block.contact[0];
  block.hardness = first.hardness, block.count = first.count, block.rolls = rolls(first);
  block.plain = block.tracking == ImpactTracking::Off && !is_driven(first) && !block.rolls;
  const bool both = first.hardness == ContactHardness::Soft;
  block.is_dynamic_a = both || is_dynamic(motion[first.body_a]);
  block.is_dynamic_b = both || is_dynamic(motion[first.body_b]);
  block.step_impulse = Number(0);
  gather_records(rows);
}

/// Reloads the members that impacts within the step change: normals of discs, separations, impulses and
/// masses.
template <class Number>
[[gnu::always_inline]] inline void regather(ContactBlock<Number>& block) {
  using Block = ContactBlock<Number>;
  using Real = typename Number::Number;
  using Constraint = ContactConstraint<Real>;
  constexpr std::size_t kFirst = offsetof(Constraint, normal), kFirstRow = offsetof(Block, normal);
  // Skips the arms (from 4 on) and the coefficients (from 24 on).
  static_assert(offsetof(Constraint, arm_tangent_a) - kFirst == 4 * sizeof(Real) &&
                offsetof(Constraint, separation) - kFirst == 8 * sizeof(Real) &&
                offsetof(Constraint, friction) - kFirst == 24 * sizeof(Real));
  const ContactRows<Number> rows{block};
  for (const int k : {0, 8, 12, 16, 20}) rows.load(kFirst + k * sizeof(Real), kFirstRow + k * sizeof(Number));
  gather_records(rows);
}

/// Writes the results of a block back to its contacts.
template <class Number>
[[gnu::always_inline]] inline void scatter(ContactBlock<Number>& block) {
  using Block = ContactBlock<Number>;
  using Real = typename Number::Number;
  using Constraint = ContactConstraint<Real>;
  const ContactRows<Number> rows{block};
  // Writes from `current_separation` to `tangent_impulse`. Skips the masses, because a deferred contact has
  // got its own back since.
  constexpr std::size_t kLast = offsetof(Constraint, normal_impulse) + sizeof(Real),
                        kLastRow = offsetof(Block, normal_impulse) + sizeof(Number);
  static_assert(offsetof(Constraint, tangent_impulse) == kLast + 3 * sizeof(Real) &&
                offsetof(Block, tangent_impulse) == kLastRow + 3 * sizeof(Number));
  rows.store(offsetof(Constraint, current_separation), offsetof(Block, current_separation));
  rows.store(kLast, kLastRow);
  if (block.tracking == ImpactTracking::Off && !block.rolls) return;
  Real rolling[Block::kLanes], max_impulses[2][Block::kLanes], sums[Block::kLanes];
  block.rolling_impulse.store(rolling), block.max_normal_impulse[0].store(max_impulses[0]),
      block.max_normal_impulse[1].store(max_impulses[1]), block.step_impulse.store(sums);
  for (int i = 0; i < Block::kLanes; ++i) {
    Constraint& c = *block.contact[i];
    if (block.rolls) c.rolling_impulse = rolling[i];
    if (c.tracking == ImpactTracking::Off) continue;
    c.max_normal_impulse[0] = max_impulses[0][i], c.max_normal_impulse[1] = max_impulses[1][i],
    c.step_impulse = sums[i];
  }
}

}  // namespace plumb
