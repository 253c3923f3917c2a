#include "engine/world/islands/jointed_islands.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/integration/free_motion.h"
#include "engine/world/islands/friction_cones.h"
#include "engine/world/islands/island_links.h"
#include "engine/world/islands/island_rows.h"
#include "engine/world/state/constants.h"

namespace plumb {
namespace {

// Typical number of rows of a contact, to estimate the cost of the factorisation.
constexpr int kContactRows = 3;

// Updates bounds that depend on other impulses: rolling resistance, and pairs of rows bounded as a vector.
// Returns true if a bound has changed so much that another solve is needed.
template <class Real>
bool renew_bounds(JointedIsland<Real>& island, bool hold) {
  bool changed = false;
  auto& rows = island.system.rows;
  const auto total = [&](int i) { return rows[i].impulse + (hold ? 0 : island.impulses[i]); };
  const auto set = [&](int i, double most) {
    BoundedRow& row = rows[i];
    const double applied = hold ? 0 : island.impulses[i];
    const double lower = -most - applied, upper = most - applied;
    constexpr double kSame = 1e-3;
    const bool matters = row.state != BoundedRow::kFree || std::abs(total(i)) > most;
    if (matters && std::abs(upper - row.upper) > kSame * most) changed = true;
    if (row.lower >= row.upper && most > 0) row.state = BoundedRow::kFree;
    row.lower = lower, row.upper = upper;
  };
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const RowTie<Real>& tie = island.ties[i];
    if (tie.first >= 0) {
      double pressure = 0;
      for (int k = 0; k < tie.count; ++k) pressure += std::max(total(tie.first + k), 0.0);
      set(i, tie.factor * pressure);
    } else if (tie.pair && tie.most < std::numeric_limits<Real>::infinity()) {
      const double x = total(i - 1), y = total(i), size = std::hypot(x, y), most = tie.most;
      if (size > most * 1.001) set(i - 1, most * std::abs(x) / size), set(i, most * std::abs(y) / size);
    }
  }
  return changed;
}

template <class Real>
void solve(JointedIsland<Real>& island, bool hold) {
  constexpr int kRenewals = 8;
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    BoundedBody& body = island.system.bodies[i];
    body.velocity = island.links[i].velocity, body.spin = island.links[i].spin;
  }
  // At rest, the remaining velocities are rounding, so errors are relative to the energy of the first solve.
  island.system.solve(hold ? 0 : island.energy);
  if (hold) island.energy = island.system.largest_energy();
  for (int i = 0; i < kRenewals; ++i) {
    const bool slips = renew_slips(island, hold), bounds = renew_bounds(island, hold);
    if (!slips && !bounds) break;
    island.system.solve_again();
  }
  for (const RowTie<Real>& tie : island.ties) {
    *tie.impulse = 0;
    if (tie.tangent != nullptr) *tie.tangent = 0;
  }
  for (std::size_t i = 0; i < island.ties.size(); ++i) {
    const double x = island.system.rows[i].impulse;
    island.impulses[i] = hold ? x : island.impulses[i] + x;
    const RowTie<Real>& tie = island.ties[i];
    *tie.impulse += static_cast<Real>(island.impulses[i]);
    if (tie.tangent != nullptr) *tie.tangent += static_cast<Real>(tie.slope * island.impulses[i]);
  }
}

template <class Real>
void put_velocity(BodyMotion<Real>& motion, Vec2d velocity, double spin) {
  if (!is_dynamic(motion)) return;
  motion.velocity = velocity.template as<Real>();
  motion.angular_velocity = static_cast<Real>(spin);
}

// Finds the fraction of the impulses from which iterations may start if they take the island over: the
// fraction that takes most energy from the motion that the forces would cause. It is 1 if the impulses
// balance a load. It is small if they stopped something, only change the direction of the motion, or come
// from rows that contradict each other except for rounding (the pull of a straight bridge).
template <class Real>
void find_carry(WorldData<Real>& w, JointedIsland<Real>& island) {
  BoundedRows& system = island.system;
  for (std::size_t k = 0; k < island.links.size(); ++k)
    system.bodies[k].velocity = island.links[k].push, system.bodies[k].spin = island.links[k].twist;
  const double carry = system.share_of_load(island.impulses);
  for (const int joint : island.joints) w.joint_set.set_carry(joint, carry);
}

// Largest mass ratio for a correction of positions. With it, chains under tips of up to 1e6 times their
// links' mass have gaps of 0.1 %; with a ratio of 100 they have 0.4 %, with 1000 1.3 %.
constexpr double kMostRatio = 10;

// Raises the masses of light bodies for a correction of positions, so that none of them moves far just to
// keep a heavy one from moving a little.
template <class Real>
void raise_masses(JointedIsland<Real>& island) {
  double least = std::numeric_limits<double>::infinity();  // inverse mass
  double most = 0;
  for (const BoundedBody& body : island.system.bodies) {
    const double inverse = std::max(body.inverse_mass.x, body.inverse_mass.y);
    if (inverse > 0) least = std::min(least, inverse), most = std::max(most, inverse);
  }
  if (!(most > kMostRatio * least)) return;
  for (BoundedBody& body : island.system.bodies) {
    const double inverse = std::max(body.inverse_mass.x, body.inverse_mass.y);
    const double factor = 1 / (1 + inverse / (kMostRatio * least));
    body.inverse_mass = factor * body.inverse_mass, body.inverse_inertia *= factor;
  }
}

// Accounts for the work of the shifts that closed joints. Shifts against the forces, such as lifting, add
// potential energy; this takes that energy from the velocities opposite to the shifts, as far as there are
// any. Otherwise bodies that are lifted in each step would fall ever faster without descending. `per_push`
// times the velocity change `push` by the forces in a substep is their acceleration.
template <class Real>
void pay_for_shift(JointedIsland<Real>& island, double share, double per_push) {
  double work = 0, along = 0, size = 0;
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    const JointedLink& link = island.links[i];
    const BoundedBody& body = island.system.bodies[i];
    const BoundedRows::Shift& s = island.system.shifts[i];
    const auto add = [&](double inverse, double way, double velocity, double push) {
      if (!(inverse > 0)) return;
      work += share * way * per_push * push / inverse;
      along += share * way * velocity / inverse, size += share * share * way * way / inverse;
    };
    add(body.inverse_mass.x, s.way.x, link.velocity.x, link.push.x);
    add(body.inverse_mass.y, s.way.y, link.velocity.y, link.push.y);
    add(body.inverse_inertia, s.turn, link.spin, link.twist);
  }
  if (!(work < 0 && along < 0)) return;
  const double rate = along / size;  // 1/s
  const double less = std::sqrt(std::max(rate * rate + 2 * work / size, 0.0)) + rate;
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    JointedLink& link = island.links[i];
    const BoundedRows::Shift& s = island.system.shifts[i];
    link.velocity -= (less * share) * s.way, link.spin -= less * share * s.turn;
  }
}

// Parameters of a correction: the fraction of joints' gaps that it closes, and the relative compliance of its
// rows.
struct Closing {
  double share = 0, softness = 0;
};

template <class Real>
Closing closing_of(const WorldData<Real>& w) {
  if (w.settings.solver == Solver::Direct) return {tuning::kDirectJointShare, tuning::kDirectCloseSoftness};
  return {tuning::kJointShare, tuning::kCloseSoftness};
}

// Makes the rows of a correction that closes gaps of joints (`joints`) or of contacts. Returns false if none
// of these are open.
template <class Real>
bool make_closing_rows(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step,
                       bool joints, double share) {
  RowMaker<Real>(w, island, step, Stage::Close).make();
  bool open = false;
  for (std::size_t i = 0; i < island.system.rows.size(); ++i) {
    BoundedRow& row = island.system.rows[i];
    const bool of_joint = static_cast<int>(i) < island.contact_row;
    if (row.state == BoundedRow::kFree) {
      row.gap *= of_joint == joints ? share : 0;
      open = open || row.gap != 0;
    } else if (of_joint != joints) {
      row.gap = std::max(row.gap, 0.0);
    }
  }
  return open;
}

// Moves bodies to close a fraction of the gaps of joints, with limited mass ratios. Bodies that press on them
// move along. The work that this does against the forces is taken from the velocities. `h` is the length of
// the substep in which the forces act, s.
template <class Real>
void close_joints(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step, double h,
                  const Closing& closing) {
  if (!make_closing_rows(w, island, step, true, closing.share)) return;
  BoundedRows& system = island.system;
  std::pmr::vector<BoundedBody>& own = island.bodies;
  own.assign(system.bodies.begin(), system.bodies.end());
  raise_masses(island);
  system.correct(closing.softness);
  std::copy(own.begin(), own.end(), system.bodies.begin());
  pay_for_shift(island, shift_links(w, island, tuning::kLinkTurn), 1 / h);
}

// Pushes overlapping bodies apart by a fraction of their overlaps, with their real masses, and with joints as
// they are. With raised masses, light bodies would lift heavy ones as far as they yield themselves, and these
// would fall back in the next step.
template <class Real>
void push_apart(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step) {
  if (!make_closing_rows(w, island, step, false, 4 * tuning::kPushShare)) return;
  island.system.correct(closing_of(w).softness);
  shift_links(w, island, tuning::kLinkTurn);
}

// ---- Motion

// Stores the poses of an island's bodies.
template <class Real>
void note_starts(const WorldData<Real>& w, JointedIsland<Real>& island) {
  note_poses(w, island);
  for (JointedLink& link : island.links)
    link.rotation_c = w.rotation[link.body].c, link.rotation_s = w.rotation[link.body].s;
}

// Moves an island's bodies back to the stored poses.
template <class Real>
void put_back(WorldData<Real>& w, const JointedIsland<Real>& island) {
  for (const JointedLink& link : island.links) {
    BodyMotion<Real>& motion = w.motion[link.body];
    motion.moved = link.moved.template as<Real>(), motion.turned = static_cast<Real>(link.turned);
    w.rotation[link.body] = {static_cast<Real>(link.rotation_c), static_cast<Real>(link.rotation_s)};
  }
}

template <class Real>
void shift_all(WorldData<Real>& w, const JointedIsland<Real>& island, double h) {
  for (const JointedLink& link : island.links) shift(w, link.body, h * link.way, h * link.turn);
}

// Finds the impulses and the velocities of a motion that begins at the stored poses with the velocities
// `before`. `velocity` is the velocity without impulses, and then the one with them.
template <class Real>
void hold(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step) {
  for (JointedLink& link : island.links) link.way = link.before, link.turn = link.spin_before;
  shift_all(w, island, 0.5 * step.h);
  RowMaker<Real>(w, island, step, Stage::Hold).make();
  solve(island, true);
  put_back(w, island);
  for (std::size_t k = 0; k < island.links.size(); ++k) {
    JointedLink& link = island.links[k];
    const BoundedBody& body = island.system.bodies[k];
    link.way = 0.5 * (link.before + body.velocity), link.turn = 0.5 * (link.spin_before + body.spin);
    link.velocity = body.velocity, link.spin = body.spin;
  }
}

// Finds the impulses after a motion, so that velocities satisfy the constraints at the present poses.
template <class Real>
void relax(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step) {
  RowMaker<Real>(w, island, step, Stage::Relax).make();
  solve(island, false);
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
constexpr int kMostParts = 64;

// Calls `look(gap)` with the gap of each rigid row and each limit at the present poses, in units of kDrift.
template <class Real, class Look>
void for_each_gap(WorldData<Real>& w, const JointedIsland<Real>& island, const Look& look) {
  std::vector<JointSolverRow<Real>>& rows = w.scratch.joint_rows;
  for (std::size_t i = 0; i < island.joints.size(); ++i) {
    rows.clear();
    w.joint_set.solver_rows(island.joints[i], w.solver_bodies(), rows);
    for (const JointSolverRow<Real>& from : rows) {
      if (from.role != RowRole::Rigid && from.role != RowRole::Limit) continue;
      const double off = from.row.residual;
      const double gap = from.role == RowRole::Rigid ? std::abs(off) : std::max(-off, 0.0);
      BoundedRow row{.a = island.blocks[i].first, .b = island.blocks[i].second};
      row.linear_a = from.row.linear_a.template as<double>();
      row.linear_b = from.row.linear_b.template as<double>();
      row.angular_a = from.row.angular_a, row.angular_b = from.row.angular_b;
      look(gap / (kDrift * link_length(island, row, from.length)));
    }
  }
}

// Returns the largest amount by which the motion from the stored poses opens a gap, in units of kDrift; 0 if
// all gaps are small at its end. The bodies are at the end of the motion, and are moved back to its start.
template <class Real>
double drift_of(WorldData<Real>& w, JointedIsland<Real>& island) {
  double widest = 0;
  island.allowed.clear();
  for_each_gap(w, island, [&](double gap) { island.allowed.push_back(gap), widest = std::max(widest, gap); });
  put_back(w, island);
  if (!(widest > 1)) return 0;
  double drift = 0;
  std::size_t place = 0;
  for_each_gap(w, island, [&](double gap) { drift = std::max(drift, island.allowed[place++] - gap); });
  return drift;
}

// Moves an island from its present poses through equal parts of a substep, each with its fraction of the
// forces. Afterwards its links have the velocities at the end, and the mean velocities of the last part.
template <class Real>
void move_through(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step, int parts) {
  ContactStep<Real> part = step;
  part.h = step.h / static_cast<Real>(parts), part.inverse_h = step.inverse_h * static_cast<Real>(parts);
  for (const int joint : island.joints) w.joint_set.set_substep(joint, part.h);
  for (JointedLink& start : island.starts) start.way = {}, start.turn = 0;
  for (JointedLink& link : island.links) link.velocity = link.before, link.spin = link.spin_before;
  const double share = 1.0 / parts;
  for (double& impulse : island.impulses) impulse *= share;
  std::pmr::vector<double>& total = island.allowed;
  for (int i = 0; i < parts; ++i) {
    note_starts(w, island);
    for (JointedLink& link : island.links) {
      link.before = link.velocity, link.spin_before = link.spin;
      link.velocity += share * link.push, link.spin += share * link.twist;
    }
    hold(w, island, part);
    shift_all(w, island, part.h);
    // Closing whole gaps at once would open joints again by ten times as much, because taut links rotate far
    // to close a small gap.
    close_joints(w, island, part, step.h, {tuning::kJointShare, tuning::kCloseSoftness});
    relax(w, island, part);
    for (std::size_t k = 0; k < island.links.size(); ++k) {
      const JointedLink& link = island.links[k];
      const BodyMotion<Real>& motion = w.motion[link.body];
      island.starts[k].way += (1 / double(step.h)) * (motion.moved.template as<double>() - link.moved);
      island.starts[k].turn += (double(motion.turned) - link.turned) / step.h;
    }
    if (i == 0) total.assign(island.impulses.size(), 0);
    for (std::size_t k = 0; k < total.size(); ++k) total[k] += island.impulses[k];
  }
  island.impulses.assign(total.begin(), total.end());
  for (const int joint : island.joints) w.joint_set.set_substep(joint, step.h);
}

// Moves an island through a substep, divided into enough parts to keep the drift small. `drift` is that of
// the undivided substep. The bodies are at its start, before and after. Ends if more parts do not halve the
// drift, which is then due to constraints that contradict the joints instead of the motion.
template <class Real>
void move_in_parts(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step,
                   double drift) {
  std::pmr::vector<JointedLink>& starts = island.starts;
  starts.assign(island.links.begin(), island.links.end());
  double before = std::numeric_limits<double>::infinity();
  for (int parts = 1; drift > 1 && drift < 0.5 * before && parts < kMostParts;) {
    // The drift should decrease with the square of the number of parts. Try two parts first to see whether it
    // does.
    const bool first = parts == 1;
    for (double left = drift; left > 1 && parts < (first ? 2 : kMostParts); left /= 4) parts *= 2;
    move_through(w, island, step, parts);
    for (std::size_t k = 0; k < starts.size(); ++k) {
      starts[k].velocity = island.links[k].velocity, starts[k].spin = island.links[k].spin;
      island.links[k] = starts[k];
    }
    before = drift, drift = drift_of(w, island);
  }
}

}  // namespace

template <class Real>
double order_jointed_island(WorldData<Real>& w, JointedIsland<Real>& island) {
  find_links(w, island);
  std::vector<JointSolverRow<Real>>& rows = w.scratch.joint_rows;
  for (const int joint : island.joints) {
    rows.clear();
    w.joint_set.solver_rows(joint, w.solver_bodies(), rows);
    const auto limits =
        std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.role == RowRole::Limit; });
    island.sizes.push_back(static_cast<int>(rows.size() - limits + (limits > 0 ? 1 : 0)));
  }
  island.sizes.insert(island.sizes.end(), island.contacts.size(), kContactRows);
  return island.system.order(island.blocks, island.sizes);
}

template <class Real>
void prepare_jointed_islands(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.jointed_count; ++i) {
    JointedIsland<Real>& island = w.scratch.jointed[i];
    find_links(w, island);
    island.impulses.clear(), island.last.clear();
    for (const ContactConstraint<Real>* c : island.contacts)
      island.last.push_back(
          {{c->normal_impulse[0], c->normal_impulse[1]}, c->tangent_impulse, c->rolling_impulse});
  }
}

template <class Real>
void begin_jointed_substep(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.jointed_count; ++i) {
    JointedIsland<Real>& island = w.scratch.jointed[i];
    for (std::size_t k = 0; k < island.links.size(); ++k) {
      JointedLink& link = island.links[k];
      const BodyMotion<Real>& motion = w.motion[link.body];
      link.before = motion.velocity.template as<double>();
      link.spin_before = motion.angular_velocity;
      if (!w.is_dynamic(link.body)) continue;
      // Sets the velocity along locked axes to zero, because the body does not move there. Otherwise the
      // reflection would pass this velocity on to other bodies.
      const Vec2d mobility = island.system.bodies[k].inverse_mass;
      if (mobility.x == 0) link.before.x = 0;
      if (mobility.y == 0) link.before.y = 0;
    }
  }
}

template <class Real>
void note_free_velocities(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.jointed_count; ++i) {
    for (JointedLink& link : w.scratch.jointed[i].links) {
      const BodyMotion<Real>& motion = w.motion[link.body];
      link.velocity = motion.velocity.template as<double>();
      link.spin = motion.angular_velocity;
    }
  }
}

template <class Real>
void note_blows(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.jointed_count; ++i) {
    for (JointedLink& link : w.scratch.jointed[i].links) {
      const BodyMotion<Real>& motion = w.motion[link.body];
      const Vec2d velocity = motion.velocity.template as<double>();
      const double spin = motion.angular_velocity;
      link.before += velocity - link.velocity, link.spin_before += spin - link.spin;
      link.velocity = velocity, link.spin = spin;
    }
  }
}

template <class Real>
void hold_jointed_islands(WorldData<Real>& w, const ContactStep<Real>& step) {
  for (int i = 0; i < w.scratch.jointed_count; ++i) {
    JointedIsland<Real>& island = w.scratch.jointed[i];
    note_starts(w, island);
    for (JointedLink& link : island.links)
      link.push = link.velocity - link.before, link.twist = link.spin - link.spin_before;
    hold(w, island, step);
    shift_all(w, island, step.h);
    if (const double drift = drift_of(w, island); drift > 1) move_in_parts(w, island, step, drift);
    if (!island.contacts.empty()) find_carry(w, island);
    for (const JointedLink& link : island.links) put_velocity(w.motion[link.body], link.way, link.turn);
  }
}

template <class Real>
void relax_jointed_islands(WorldData<Real>& w, const ContactStep<Real>& step, bool last) {
  const bool close = last || w.settings.solver == Solver::Direct;
  for (int i = 0; i < w.scratch.jointed_count; ++i) {
    JointedIsland<Real>& island = w.scratch.jointed[i];
    // These impulses replace those of the pass over all contacts.
    for (ContactConstraint<Real>* c : island.contacts)
      if (c->watched != Watch::Off) c->step_impulse -= normal_sum(*c);
    if (close) {
      close_joints(w, island, step, step.h, closing_of(w));
      if (!island.contacts.empty()) push_apart(w, island, step);
    }
    relax(w, island, step);
    for (const JointedLink& link : island.links) put_velocity(w.motion[link.body], link.velocity, link.spin);
    for (ContactConstraint<Real>* c : island.contacts)
      if (c->watched != Watch::Off) note_peaks(*c), c->step_impulse += normal_sum(*c);
    if (last || !island.contacts.empty()) find_carry(w, island);
  }
}

#define PLUMB_FOR(Real)                                                           \
  template double order_jointed_island(WorldData<Real>&, JointedIsland<Real>&);   \
  template void prepare_jointed_islands(WorldData<Real>&);                        \
  template void begin_jointed_substep(WorldData<Real>&);                          \
  template void note_free_velocities(WorldData<Real>&);                           \
  template void note_blows(WorldData<Real>&);                                     \
  template void hold_jointed_islands(WorldData<Real>&, const ContactStep<Real>&); \
  template void relax_jointed_islands(WorldData<Real>&, const ContactStep<Real>&, bool);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
