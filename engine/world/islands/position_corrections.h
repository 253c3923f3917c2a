#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "engine/world/ablation/ablation.h"
#include "engine/world/islands/island_links.h"
#include "engine/world/islands/island_rows.h"
#include "engine/world/state/constants.h"

/// Corrections of the positions of an island with joints. Only jointed_islands.cpp uses them.
namespace plumb {

// Largest mass ratio for a correction of positions. With it, chains under tips of up to 1e6 times their
// links' mass have gaps of 0.1 %; with a ratio of 100 they have 0.4 %, with 1000 1.3 %.
inline constexpr double kMaxMassRatio = 10;

// Raises the masses of light bodies for a correction of positions, so that none of them moves far just to
// keep a heavy one from moving a little.
template <class Real>
void limit_mass_ratio(JointedIsland<Real>& island) {
  if (!enabled(Switch::MassLimits)) return;
  double least = std::numeric_limits<double>::infinity();  // inverse mass
  double most = 0;
  for (const BoundedBody& body : island.system.bodies) {
    const double inverse = std::max(body.inverse_mass.x, body.inverse_mass.y);
    if (inverse > 0) least = std::min(least, inverse), most = std::max(most, inverse);
  }
  if (!(most > kMaxMassRatio * least)) return;
  for (BoundedBody& body : island.system.bodies) {
    const double inverse = std::max(body.inverse_mass.x, body.inverse_mass.y);
    const double factor = 1 / (1 + inverse / (kMaxMassRatio * least));
    body.inverse_mass = factor * body.inverse_mass, body.inverse_inertia *= factor;
  }
}

// Compensates the work of the displacements that closed joints. Displacements against the forces, such as
// lifting, add potential energy. This energy is taken from the velocities opposite to them, as far as there
// are any. Otherwise bodies that are lifted in each step would fall ever faster without descending.
// `per_increment` times the velocity increment by the forces of a substep is their acceleration.
template <class Real>
void compensate_shift_work(JointedIsland<Real>& island, double fraction, double per_increment) {
  if (!enabled(Switch::ShiftWork)) return;
  // Bodies that come to rest have displacements whose squares underflow, so displacements are divided by a
  // power of two near the largest.
  double largest = 0;
  for (const BoundedRows::Displacement& s : island.system.displacements)
    largest = std::max({largest, std::abs(s.translation.x), std::abs(s.translation.y), std::abs(s.rotation)});
  if (!(largest > 0)) return;
  constexpr int kLeastExponent = -1000;  // the inverse of 2 to this is finite
  const int exponent = std::max(std::ilogb(largest), kLeastExponent);
  const double scale = std::ldexp(1.0, -exponent);
  const auto scaled = [&](double displacement) { return fraction * (scale * displacement); };
  double work = 0, along = 0, size = 0;
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    const JointedLink& link = island.links[i];
    const BoundedBody& body = island.system.bodies[i];
    const BoundedRows::Displacement& s = island.system.displacements[i];
    const auto add = [&](double inverse, double displacement, double velocity, double increment) {
      if (!(inverse > 0)) return;
      work += displacement * per_increment * increment / inverse;
      along += displacement * velocity / inverse, size += displacement * displacement / inverse;
    };
    add(body.inverse_mass.x, scaled(s.translation.x), link.velocity.x, link.velocity_increment.x);
    add(body.inverse_mass.y, scaled(s.translation.y), link.velocity.y, link.velocity_increment.y);
    add(body.inverse_inertia, scaled(s.rotation), link.spin, link.spin_increment);
  }
  if (!(work < 0 && along < 0)) return;
  const double rate = along / size;  // 1/s, times the power of two
  const double gain = std::ldexp(2 * work / size, exponent);
  const double less = std::sqrt(std::max(rate * rate + gain, 0.0)) + rate;
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    JointedLink& link = island.links[i];
    const BoundedRows::Displacement& s = island.system.displacements[i];
    link.velocity -= less * Vec2d{scaled(s.translation.x), scaled(s.translation.y)};
    link.spin -= less * scaled(s.rotation);
  }
}

/// Parameters of a correction: the fraction of joints' gaps that it closes, and the relative compliance of
/// its rows.
struct GapCorrection {
  double fraction = 0, softness = 0;
};

template <class Real>
GapCorrection gap_correction_of(const WorldData<Real>& w) {
  if (w.settings.solver == Solver::Direct)
    return {tuning::kDirectCorrectionFraction, tuning::kDirectCorrectionSoftness};
  return {tuning::kJointCorrectionFraction, tuning::kCorrectionSoftness};
}

// Makes the rows of a correction that closes gaps of joints (`joints`) or of contacts. Returns false if none
// of these are open.
template <class Real>
bool make_correction_rows(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step,
                          bool joints, double fraction) {
  RowBuilder<Real>(w, island, step, Stage::Correct).build();
  bool open = false;
  for (std::size_t i = 0; i < island.system.rows.size(); ++i) {
    BoundedRow& row = island.system.rows[i];
    const bool of_joint = static_cast<int>(i) < island.first_contact_row;
    if (row.state == BoundedRow::kFree) {
      row.gap *= of_joint == joints ? fraction : 0;
      open = open || row.gap != 0;
    } else if (of_joint != joints) {
      row.gap = std::max(row.gap, 0.0);
    }
  }
  return open;
}

/// Moves bodies to close a fraction of the gaps of joints, with limited mass ratios. Bodies that press on
/// them move along. The work that this does against the forces is taken from the velocities. `h` is the
/// length of the substep in which the forces act, s.
template <class Real>
void close_joints(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step, double h,
                  const GapCorrection& closing) {
  if (!make_correction_rows(w, island, step, true, closing.fraction)) return;
  BoundedRows& system = island.system;
  std::pmr::vector<BoundedBody>& saved = island.saved_bodies;
  saved.assign(system.bodies.begin(), system.bodies.end());
  limit_mass_ratio(island);
  system.correct(closing.softness);
  std::copy(saved.begin(), saved.end(), system.bodies.begin());
  compensate_shift_work(island, displace_links(w, island, tuning::kMaxCorrectionRotation), 1 / h);
}

/// Pushes overlapping bodies apart by a fraction of their overlaps, with their real masses, and with joints
/// as they are. With raised masses, light bodies would lift heavy ones as far as they move themselves, and
/// these would fall back in the next step.
template <class Real>
void correct_penetrations(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step) {
  if (!make_correction_rows(w, island, step, false, 4 * tuning::kDirectPushFraction)) return;
  island.system.correct(gap_correction_of(w).softness);
  displace_links(w, island, tuning::kMaxCorrectionRotation);
}

}  // namespace plumb
