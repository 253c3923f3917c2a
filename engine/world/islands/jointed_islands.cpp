#include "engine/world/islands/jointed_islands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/world/ablation/ablation.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/islands/energy_bounds.h"
#include "engine/world/islands/friction_cones.h"
#include "engine/world/islands/island_links.h"
#include "engine/world/islands/island_rows.h"
#include "engine/world/islands/position_corrections.h"
#include "engine/world/state/constants.h"

namespace plumb {
namespace {

// Typical number of rows of a contact, to estimate the cost of the factorisation.
constexpr int kContactRows = 3;

// Updates bounds that depend on other impulses: rolling resistance, and pairs of rows bounded as a vector.
// Returns true if a bound has changed so much that another solve is needed.
template <class Real>
bool update_bounds(JointedIsland<Real>& island, bool midpoint) {
  bool changed = false;
  auto& rows = island.system.rows;
  const auto applied = [&](int i) { return midpoint ? 0 : island.impulses[i]; };
  const auto total = [&](int i) { return rows[i].impulse + applied(i); };
  const auto set = [&](int i, double most) {
    BoundedRow& row = rows[i];
    const double lower = -most - applied(i), upper = most - applied(i);
    constexpr double kTolerance = 1e-3;
    const bool matters = row.state != BoundedRow::kFree || std::abs(total(i)) > most;
    if (matters && std::abs(upper - row.upper) > kTolerance * most) changed = true;
    if (row.lower >= row.upper && most > 0) row.state = BoundedRow::kFree;
    row.lower = lower, row.upper = upper;
  };
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const RowSource<Real>& source = island.row_sources[i];
    if (source.first >= 0) {
      double pressure = 0;
      for (int k = 0; k < source.count; ++k) pressure += std::max(total(source.first + k), 0.0);
      set(i, source.factor * pressure);
    } else if (source.pair && source.max_impulse < std::numeric_limits<Real>::infinity()) {
      // At its bound the vector points where it would point without. The impulses themselves point along the
      // diagonal as soon as each has reached a bound of its own.
      const double x = island.system.unbounded_impulse(i - 1) + applied(i - 1),
                   y = island.system.unbounded_impulse(i) + applied(i);
      const double most = source.max_impulse, scale = most / std::max(std::hypot(x, y), most);
      set(i - 1, scale < 1 ? scale * std::abs(x) : most), set(i, scale < 1 ? scale * std::abs(y) : most);
    }
  }
  return changed;
}

// Solves the rows for the links' velocities.
template <class Real>
void solve_rows(JointedIsland<Real>& island, bool midpoint) {
  constexpr int kMaxUpdates = 8;
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    BoundedBody& body = island.system.bodies[i];
    body.velocity = island.links[i].velocity, body.spin = island.links[i].spin;
  }
  // At rest, the remaining velocities are rounding, so errors are relative to the energy of the first solve.
  island.system.solve(midpoint ? 0 : island.energy);
  if (midpoint) island.energy = island.system.energy_scale();
  const auto settle = [&] {
    for (int i = 0; i < (island.system.is_exhausted() ? 1 : kMaxUpdates); ++i) {
      const bool slips = update_slips(island, midpoint), bounds = update_bounds(island, midpoint);
      if (!slips && !bounds) return true;
      island.system.solve_again();
    }
    return false;
  };
  if (!settle() || !midpoint || !release_jammed(island)) return;
  island.system.solve_again();
  set_released_slips(island, midpoint);
  island.system.solve_again();
  if (settle()) return;
  hold_released(island, midpoint);
  island.system.solve_again();
}

// Stores the impulses of the last solution.
template <class Real>
void store_impulses(JointedIsland<Real>& island, bool midpoint) {
  for (const RowSource<Real>& source : island.row_sources) {
    *source.impulse = 0;
    if (source.tangent != nullptr) *source.tangent = 0;
  }
  for (std::size_t i = 0; i < island.row_sources.size(); ++i) {
    const double x = island.system.rows[i].impulse;
    island.impulses[i] = midpoint ? x : island.impulses[i] + x;
    const RowSource<Real>& source = island.row_sources[i];
    *source.impulse += static_cast<Real>(island.impulses[i]);
    if (source.tangent != nullptr) *source.tangent += static_cast<Real>(source.slope * island.impulses[i]);
  }
}

// Solves the rows of a stage. Drivers' joints yield as little as keeps the increase of the root of the energy
// within `budget`, which is reduced by the increase. Its last thousandth remains, so that drivers stay
// drivers in all parts of a substep.
template <class Real>
void solve(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step, Stage stage,
           double& budget) {
  const bool midpoint = stage == Stage::Midpoint, driven = budget > 0;
  const double before = driven ? root_energy_of_links(island) : 0;
  for (double yield = 0;; yield = yield > 0 ? yield * kYieldFactor : kLeastYield) {
    RowBuilder<Real>(w, island, step, stage, yield).build();
    solve_rows(island, midpoint);
    if (!driven) break;
    const double increase = std::max(root_energy_of_solution(island) - before, 0.0);
    if (increase > budget && yield < kMostYield) continue;
    budget = std::max(budget - increase, 1e-3 * budget);
    for (JointedLink& link : island.links) link.yields = link.yields || (yield > 0 && is_driver(w, link));
    break;
  }
  store_impulses(island, midpoint);
}

template <class Real>
void store_velocity(SolverBody<Real>& motion, Vec2d velocity, double spin) {
  if (!is_dynamic(motion)) return;
  motion.velocity = velocity.template as<Real>();
  motion.angular_velocity = static_cast<Real>(spin);
}

// Difference of the fractions of their impulses that soft joints and soft contacts forget in an iteration
// (Softness::impulse_scale, 0.103 and 0.058). With 0.074, of joints and contacts with static bodies, as many
// of 150 heaps gain energy; with 0, two more, and one 1.5 times what it has.
constexpr double kLeak = 0.045;

// Returns the work of the rows' impulses from `first` on, on the velocities that they alone cause, J.
template <class Real>
double work_on_own_response(JointedIsland<Real>& island, int first) {
  BoundedRows& system = island.system;
  for (BoundedBody& body : system.bodies) body.velocity = {}, body.spin = 0;
  for (std::size_t i = first; i < system.rows.size(); ++i)
    system.apply_impulse(system.rows[i], island.impulses[i]);
  double work = 0;
  for (std::size_t i = first; i < system.rows.size(); ++i)
    work += island.impulses[i] * system.row_velocity(system.rows[i]);
  return work;
}

// Finds the fraction of the impulses from which iterations may start if they take the island over: the
// fraction that takes most energy from the motion that the forces would cause. It is 1 if the impulses
// balance a load. It is small if they stopped something, only change the direction of the motion, or come
// from rows that contradict each other except for rounding (the pull of a straight bridge). It is small as
// well if contacts press against joints with many times the load, because iterations forget different
// fractions of the two. Drivers' rows are told the fraction that balances the load alone.
template <class Real>
void update_warm_start_fraction(WorldData<Real>& w, JointedIsland<Real>& island) {
  BoundedRows& system = island.system;
  const bool driven = std::any_of(island.links.begin(), island.links.end(),
                                  [&](const JointedLink& link) { return is_driver(w, link); });
  const double lost = driven ? 0 : work_on_own_response(island, island.first_contact_row);
  for (std::size_t k = 0; k < island.links.size(); ++k)
    system.bodies[k].velocity = island.links[k].velocity_increment,
    system.bodies[k].spin = island.links[k].spin_increment;
  const double fraction = system.best_load_fraction(island.impulses, kLeak * kLeak * lost);
  for (const int joint : island.joints) w.joint_set.set_warm_start_fraction(joint, fraction);
}

// ---- Motion

// Stores the poses of an island's bodies.
template <class Real>
void save_poses(const WorldData<Real>& w, JointedIsland<Real>& island) {
  save_displacements(w, island);
  for (JointedLink& link : island.links)
    link.rotation_c = w.rotation[link.body].c, link.rotation_s = w.rotation[link.body].s;
}

// Moves an island's bodies back to the stored poses.
template <class Real>
void restore_poses(WorldData<Real>& w, const JointedIsland<Real>& island) {
  for (const JointedLink& link : island.links) {
    SolverBody<Real>& motion = w.motion[link.body];
    motion.delta_position = link.delta_position.template as<Real>(),
    motion.delta_angle = static_cast<Real>(link.delta_angle);
    w.rotation[link.body] = {static_cast<Real>(link.rotation_c), static_cast<Real>(link.rotation_s)};
  }
}

template <class Real>
void advance_links(WorldData<Real>& w, const JointedIsland<Real>& island, double h) {
  for (const JointedLink& link : island.links)
    displace_body(w, link.body, h * link.mean_velocity, h * link.mean_spin);
}

// Finds the impulses and the velocities of a motion that begins at the stored poses with the velocities
// `before`. `velocity` is the velocity without impulses, and then the one with them.
template <class Real>
void solve_midpoint(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step,
                    double& budget) {
  for (JointedLink& link : island.links)
    link.mean_velocity = link.start_velocity, link.mean_spin = link.start_spin;
  advance_links(w, island, 0.5 * step.h);
  solve(w, island, step, Stage::Midpoint, budget);
  restore_poses(w, island);
  for (std::size_t k = 0; k < island.links.size(); ++k) {
    JointedLink& link = island.links[k];
    const BoundedBody& body = island.system.bodies[k];
    link.mean_velocity = 0.5 * (link.start_velocity + body.velocity),
    link.mean_spin = 0.5 * (link.start_spin + body.spin);
    link.velocity = body.velocity, link.spin = body.spin;
  }
}

// Finds the impulses after a motion, so that velocities satisfy the constraints at the present poses. With
// drivers `budget` bounds what they and all other rows gain.
template <class Real>
void relax(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step, double& budget) {
  solve(w, island, step, Stage::Relax, budget);
  if (enabled(Switch::KeptImpulses) && !(budget > 0) && gains_by_taking_back(island)) {
    keep_impulses(w, island, step);
    solve_rows(island, false);
    store_impulses(island, false);
  }
  for (std::size_t k = 0; k < island.links.size(); ++k) {
    const BoundedBody& body = island.system.bodies[k];
    island.links[k].velocity = body.velocity, island.links[k].spin = body.spin;
  }
}

// ---- Division of a substep. If light links rotate far under a load, joints drift by more (of third order in
// h) than closing gaps can make up for.

// Tolerated drift of a row in a substep, as a fraction of its link. Each step of four substeps closes half of
// the gaps, so they stay within 8 times this value.
constexpr double kDrift = 5e-4;
// Largest number of parts into which a substep is divided.
constexpr int kMaxParts = 64;
// Effort of a part of a substep, in that of finding the impulses of the middle: those, closing joints,
// relaxing.
constexpr double kSolutionsOfPart = 3;

// Calls `look(gap)` with the gap of each rigid row and each limit at the present poses, in units of kDrift.
template <class Real, class Visit>
void for_each_gap(WorldData<Real>& w, const JointedIsland<Real>& island, const Visit& visit) {
  std::vector<JointSolverRow<Real>>& rows = w.scratch.solver.joint_rows;
  for (std::size_t i = 0; i < island.joints.size(); ++i) {
    rows.clear();
    w.joint_set.solver_rows(island.joints[i], w.solver_bodies(), rows);
    for (const JointSolverRow<Real>& from : rows) {
      if (from.role != RowRole::Rigid && from.role != RowRole::Limit) continue;
      const double residual = from.row.residual;
      const double gap = from.role == RowRole::Rigid ? std::abs(residual) : std::max(-residual, 0.0);
      BoundedRow row{.a = island.blocks[i].first, .b = island.blocks[i].second};
      row.linear_a = from.row.linear_a.template as<double>();
      row.linear_b = from.row.linear_b.template as<double>();
      row.angular_a = from.row.angular_a, row.angular_b = from.row.angular_b;
      visit(gap / (kDrift * link_length(island, row, from.length)));
    }
  }
}

// Returns the largest amount by which the motion from the stored poses opens a gap, in units of kDrift; 0 if
// all gaps are small at its end. The bodies are at the end of the motion, and are moved back to its start.
template <class Real>
double drift_of(WorldData<Real>& w, JointedIsland<Real>& island) {
  double widest = 0;
  island.max_gaps.clear();
  for_each_gap(w, island,
               [&](double gap) { island.max_gaps.push_back(gap), widest = std::max(widest, gap); });
  restore_poses(w, island);
  if (!(widest > 1)) return 0;
  double drift = 0;
  std::size_t index = 0;
  for_each_gap(w, island, [&](double gap) { drift = std::max(drift, island.max_gaps[index++] - gap); });
  return drift;
}

// Moves an island from its present poses through equal parts of a substep, each with its fraction of the
// forces. Afterwards its links have the velocities at the end, and the mean velocities of the last part.
template <class Real>
void step_in_parts(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step,
                   int parts) {
  ContactStep<Real> part = step;
  part.h = step.h / static_cast<Real>(parts), part.inverse_h = step.inverse_h * static_cast<Real>(parts);
  for (const int joint : island.joints) w.joint_set.set_substep(joint, part.h);
  for (JointedLink& start : island.saved_links) start.mean_velocity = {}, start.mean_spin = 0;
  for (JointedLink& link : island.links) link.velocity = link.start_velocity, link.spin = link.start_spin;
  const double fraction = 1.0 / parts;
  double budget = budget_of(w, island);
  for (double& impulse : island.impulses) impulse *= fraction;
  std::pmr::vector<double>& total = island.max_gaps;
  for (int i = 0; i < parts; ++i) {
    save_poses(w, island);
    for (JointedLink& link : island.links) {
      link.start_velocity = link.velocity, link.start_spin = link.spin;
      link.velocity += fraction * link.velocity_increment, link.spin += fraction * link.spin_increment;
    }
    solve_midpoint(w, island, part, budget);
    advance_links(w, island, part.h);
    // Closing whole gaps at once would open joints again by ten times as much, because taut links rotate far
    // to close a small gap.
    close_joints(w, island, part, step.h, {tuning::kJointCorrectionFraction, tuning::kCorrectionSoftness});
    relax(w, island, part, budget);
    for (std::size_t k = 0; k < island.links.size(); ++k) {
      const JointedLink& link = island.links[k];
      const SolverBody<Real>& motion = w.motion[link.body];
      island.saved_links[k].mean_velocity +=
          (1 / double(step.h)) * (motion.delta_position.template as<double>() - link.delta_position);
      island.saved_links[k].mean_spin += (double(motion.delta_angle) - link.delta_angle) / step.h;
    }
    if (i == 0) total.assign(island.impulses.size(), 0);
    for (std::size_t k = 0; k < total.size(); ++k) total[k] += island.impulses[k];
  }
  island.impulses.assign(total.begin(), total.end());
  for (const int joint : island.joints) w.joint_set.set_substep(joint, step.h);
}

// Moves an island through a substep, divided into enough parts to keep the drift small. `drift` is that of
// the undivided substep. The bodies are at its start, before and after. Ends if more parts do not halve the
// drift, which is then due to constraints that contradict the joints instead of the motion. Ends as well
// where the parts would take more effort than the step has left.
template <class Real>
void subdivide_substep(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step,
                       double drift, double effort) {
  std::pmr::vector<JointedLink>& starts = island.saved_links;
  starts.assign(island.links.begin(), island.links.end());
  double before = std::numeric_limits<double>::infinity();
  BoundedRows& system = island.system;
  const auto max_parts = [&] {
    const double left = (system.effort_limit - system.effort) / (kSolutionsOfPart * effort);
    return left < kMaxParts ? static_cast<int>(left) : kMaxParts;
  };
  for (int parts = 1; drift > 1 && drift < 0.5 * before && 2 * parts <= max_parts();) {
    // The drift should decrease with the square of the number of parts. Try two parts first to see whether it
    // does.
    const bool first = parts == 1;
    const int most = first ? 2 : max_parts();
    for (double left = drift; left > 1 && 2 * parts <= most; left /= 4) parts *= 2;
    step_in_parts(w, island, step, parts);
    for (std::size_t k = 0; k < starts.size(); ++k) {
      starts[k].velocity = island.links[k].velocity, starts[k].spin = island.links[k].spin;
      starts[k].yields = island.links[k].yields;
      island.links[k] = starts[k];
    }
    before = drift, drift = drift_of(w, island);
  }
}

}  // namespace

template <class Real>
double order_jointed_island(WorldData<Real>& w, JointedIsland<Real>& island) {
  find_links(w, island);
  std::vector<JointSolverRow<Real>>& rows = w.scratch.solver.joint_rows;
  for (const int joint : island.joints) {
    rows.clear();
    w.joint_set.solver_rows(joint, w.solver_bodies(), rows);
    const auto limits =
        std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.role == RowRole::Limit; });
    island.block_sizes.push_back(static_cast<int>(rows.size() - limits + (limits > 0 ? 1 : 0)));
  }
  island.block_sizes.insert(island.block_sizes.end(), island.contacts.size(), kContactRows);
  return island.system.order(island.blocks, island.block_sizes);
}

template <class Real>
void load_impulses(JointedIsland<Real>& island) {
  island.impulses.clear(), island.last_impulses.clear();
  for (const ContactConstraint<Real>* c : island.contacts)
    island.last_impulses.push_back(
        {{c->normal_impulse[0], c->normal_impulse[1]}, c->tangent_impulse, c->rolling_impulse});
}

template <class Real>
void prepare_jointed_islands(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i) {
    JointedIsland<Real>& island = w.scratch.islands.jointed_islands[i];
    find_links(w, island);
    find_link_groups(w, island);
    load_impulses(island);
  }
}

template <class Real>
void begin_jointed_substep(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i) {
    JointedIsland<Real>& island = w.scratch.islands.jointed_islands[i];
    for (std::size_t k = 0; k < island.links.size(); ++k) {
      JointedLink& link = island.links[k];
      const SolverBody<Real>& motion = w.motion[link.body];
      link.start_velocity = motion.velocity.template as<double>();
      link.start_spin = motion.angular_velocity;
      if (!w.is_dynamic(link.body)) continue;
      // Sets the velocity along locked axes to zero, because the body does not move there. Otherwise the
      // reflection would pass this velocity on to other bodies.
      const Vec2d mobility = island.system.bodies[k].inverse_mass;
      if (mobility.x == 0) link.start_velocity.x = 0;
      if (mobility.y == 0) link.start_velocity.y = 0;
    }
  }
}

template <class Real>
void save_free_velocities(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i) {
    for (JointedLink& link : w.scratch.islands.jointed_islands[i].links) {
      const SolverBody<Real>& motion = w.motion[link.body];
      link.velocity = motion.velocity.template as<double>();
      link.spin = motion.angular_velocity;
    }
  }
}

template <class Real>
void add_impact_velocities(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i) {
    for (JointedLink& link : w.scratch.islands.jointed_islands[i].links) {
      const SolverBody<Real>& motion = w.motion[link.body];
      const Vec2d velocity = motion.velocity.template as<double>();
      const double spin = motion.angular_velocity;
      link.start_velocity += velocity - link.velocity, link.start_spin += spin - link.spin;
      link.velocity = velocity, link.spin = spin;
    }
  }
}

template <class Real>
void solve_jointed_islands(WorldData<Real>& w, const ContactStep<Real>& step) {
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i) {
    JointedIsland<Real>& island = w.scratch.islands.jointed_islands[i];
    save_poses(w, island);
    for (JointedLink& link : island.links)
      link.velocity_increment = link.velocity - link.start_velocity,
      link.spin_increment = link.spin - link.start_spin;
    double budget = budget_of(w, island);
    // Loads that drivers pull are solved until they yield: inexact impulses would throw them.
    const double before = island.system.effort;
    island.system.effort_limit =
        budget > 0 ? std::numeric_limits<double>::infinity() : before + tuning::kJointedEffort;
    solve_midpoint(w, island, step, budget);
    const double effort = island.system.effort - before;
    advance_links(w, island, step.h);
    if (const double drift = drift_of(w, island); drift > 1 && enabled(Switch::DividedSubsteps))
      subdivide_substep(w, island, step, drift, effort);
    if (!island.contacts.empty() && !island.joints.empty()) update_warm_start_fraction(w, island);
    for (const JointedLink& link : island.links)
      store_velocity(w.motion[link.body], link.mean_velocity, link.mean_spin);
  }
}

template <class Real>
void relax_jointed_islands(WorldData<Real>& w, const ContactStep<Real>& step, bool last) {
  const bool close = last || w.settings.solver == Solver::Direct;
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i) {
    JointedIsland<Real>& island = w.scratch.islands.jointed_islands[i];
    // These impulses replace those of the pass over all contacts.
    for (ContactConstraint<Real>* c : island.contacts)
      if (c->tracking != ImpactTracking::Off) c->step_impulse -= normal_sum(*c);
    if (close) {
      close_joints(w, island, step, step.h, gap_correction_of(w));
      if (!island.contacts.empty() && enabled(Switch::PenetrationCorrections))
        correct_penetrations(w, island, step);
    }
    double budget = budget_of(w, island);
    relax(w, island, step, budget);
    for (const JointedLink& link : island.links)
      store_velocity(w.motion[link.body], link.velocity, link.spin);
    for (ContactConstraint<Real>* c : island.contacts)
      if (c->tracking != ImpactTracking::Off) record_max_impulse(*c), c->step_impulse += normal_sum(*c);
    if (!island.joints.empty() && (last || !island.contacts.empty())) update_warm_start_fraction(w, island);
  }
}

#define PLUMB_FOR(Real)                                                            \
  template double order_jointed_island(WorldData<Real>&, JointedIsland<Real>&);    \
  template void load_impulses(JointedIsland<Real>&);                               \
  template void prepare_jointed_islands(WorldData<Real>&);                         \
  template void begin_jointed_substep(WorldData<Real>&);                           \
  template void save_free_velocities(WorldData<Real>&);                            \
  template void add_impact_velocities(WorldData<Real>&);                           \
  template void solve_jointed_islands(WorldData<Real>&, const ContactStep<Real>&); \
  template void relax_jointed_islands(WorldData<Real>&, const ContactStep<Real>&, bool);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
