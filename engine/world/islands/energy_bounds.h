#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/world/ablation/ablation.h"
#include "engine/world/islands/island_rows.h"
#include "engine/world/world_data.h"

/// Kinetic energy of an island with joints, and what may raise it in a substep. Only jointed_islands.cpp uses
/// this.
namespace plumb {

/// Returns twice the kinetic energy of an island's dynamic bodies, J, at the velocities that `velocity_of(k)`
/// returns: a pair of linear, m/s, and angular, rad/s.
template <class Real, class Velocity>
double twice_energy(const JointedIsland<Real>& island, const Velocity& velocity_of) {
  double sum = 0;
  for (std::size_t k = 0; k < island.links.size(); ++k) {
    const BoundedBody& body = island.system.bodies[k];
    const auto [v, spin] = velocity_of(k);
    if (body.inverse_mass.x > 0) sum += v.x * v.x / body.inverse_mass.x;
    if (body.inverse_mass.y > 0) sum += v.y * v.y / body.inverse_mass.y;
    if (body.inverse_inertia > 0) sum += spin * spin / body.inverse_inertia;
  }
  return sum;
}

/// Returns the root of twice the energy of an island's bodies, J^1/2: before a solve, and after it.
template <class Real>
double root_energy_of_links(const JointedIsland<Real>& island) {
  return std::sqrt(twice_energy(
      island, [&](std::size_t k) { return std::pair(island.links[k].velocity, island.links[k].spin); }));
}
template <class Real>
double root_energy_of_solution(const JointedIsland<Real>& island) {
  return std::sqrt(twice_energy(island, [&](std::size_t k) {
    return std::pair(island.system.bodies[k].velocity, island.system.bodies[k].spin);
  }));
}

// ---- Impulses that are taken back. After the motion, rows have other directions than when their impulses
// were found, and a row that is pressed may give back what it had. Impulses that only press bodies against
// each other are then no longer balanced: two bars on one hinge that touch 2 mm from it, with friction, carry
// 400 times their load, and flew apart at 30 times their energy.

/// Returns true if an island has more energy after relaxing than both its forces and its motion gave it, and
/// impulses that were taken back did more than half of that work.
template <class Real>
bool gains_by_taking_back(const JointedIsland<Real>& island) {
  double work = 0;
  for (const BoundedRow& row : island.system.rows)
    if (row.impulse < 0 && row.target < 0 && is_one_sided(row)) work += row.impulse * row.target;
  if (!(work > 0)) return false;
  const double after = root_energy_of_solution(island);
  const double free = std::sqrt(twice_energy(island, [&](std::size_t k) {
    const JointedLink& link = island.links[k];
    return std::pair(link.start_velocity + link.velocity_increment, link.start_spin + link.spin_increment);
  }));
  const double before = std::max(root_energy_of_links(island), free);
  return after > before && work > 0.25 * (after * after - before * before);
}

/// Lets the rows of an island add to their impulses, but not take back any. These do no work, because no
/// one-sided row demands a positive speed. The rows are built anew: those that were infeasible have the
/// velocities that they reached as targets, on which the impulses of another solution may do any work (a heap
/// of ragdolls at rest left at 1e7 m/s).
template <class Real>
void keep_impulses(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step) {
  std::pmr::vector<BoundedRow>& rows = island.system.rows;
  for (std::size_t i = 0; i < rows.size(); ++i) island.impulses[i] -= rows[i].impulse;
  RowBuilder<Real>(w, island, step, Stage::Relax).build();
  for (BoundedRow& row : rows)
    if (is_one_sided(row)) row.lower = std::max(row.lower, 0.0);
}

// ---- Drivers: kinematic bodies that move, and do whatever work that takes. If the load of one is caught,
// rows contradict each other, or nearly so. A crate whose corner is pulled into the floor can follow only by
// turning about that corner, the faster the smaller the arm that the pull has left: rigid rows turned it at
// 1,000 rad/s for a pull of 0.3 m/s. So the rows between drivers and their loads yield as little as bounds
// the drivers' work.

// Largest increase of the root of the bodies' energy by drivers in a solve of a substep, as a multiple of
// that of bodies that move with the drivers as one rigid body. Loads that are free take at most 2: the solve
// at the middle reflects velocities. At 3 a lever of 1:5 follows at once. Of 33 pulls of a crate into a floor
// at 0.05 to 3 sizes a second, the fastest reaches 26 sizes a second (30 at 5, 19 with the next limit too).
inline constexpr double kMaxDriveRatio = 3;
// Multiple of the same at which this limit has fallen to kLeastDriveRatio: otherwise a load that stays caught
// would gain in each substep. Bodies that are faster for other reasons (a flail) follow with
// kLeastDriveRatio.
inline constexpr double kMaxDrivenRatio = 6, kLeastDriveRatio = 0.25;
// Compliances of these rows, as fractions of their mobility, which are tried one after the other. The least
// one still stops a load that was caught 1,000 times too fast; with the largest one a row gives a free load
// half of its impulse, and takes no more energy from the driver than moves the load at the driver's speed.
// With steps by a factor of 2 a solve would be repeated 20 times, not 7.
inline constexpr double kLeastYield = 1e-6, kMostYield = 1, kYieldFactor = 10;

/// Returns the work that drivers may do in a solve of a substep, as an increase of the root of twice the
/// energy: their sum for bodies that move with them as one rigid body, times kMaxDriveRatio; 0 without
/// drivers.
template <class Real>
double budget_of(const WorldData<Real>& w, const JointedIsland<Real>& island) {
  if (!enabled(Switch::DriverBudget)) return 0;
  double sum = 0;
  for (const JointedLink& driver : island.links) {
    if (!is_driver(w, driver)) continue;
    const Vec2d centre = w.position[driver.body];
    sum += std::sqrt(twice_energy(island, [&](std::size_t k) {
      const Vec2d arm = w.position[island.links[k].body] - centre;
      return std::pair(driver.start_velocity + driver.start_spin * Vec2d{-arm.y, arm.x}, driver.start_spin);
    }));
  }
  if (!(sum > 0)) return 0;
  const double ratio = root_energy_of_links(island) / (kMaxDrivenRatio * sum);
  return std::max(kMaxDriveRatio * (1 - ratio), kLeastDriveRatio) * sum;
}

}  // namespace plumb
