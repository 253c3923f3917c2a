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

// Typical number of a contact's rows, to estimate the cost of the factorisation.
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
  // At rest what is left of the velocities is rounding: errors are relative to what was solved before.
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

// Finds the fraction of the impulses with which iterations may start, should they take the island over: the
// one that takes most energy from the motion that forces would cause. It is 1 where the impulses balance a
// load. It is small where they have stopped something, or only turn the motion, or are due to rows that
// exclude each other but for rounding (the pull of a bridge that is straight).
template <class Real>
void find_carry(WorldData<Real>& w, JointedIsland<Real>& island) {
  BoundedRows& system = island.system;
  for (std::size_t k = 0; k < island.links.size(); ++k)
    system.bodies[k].velocity = island.links[k].push, system.bodies[k].spin = island.links[k].twist;
  const double carry = system.share_of_load(island.impulses);
  for (const int joint : island.joints) w.joint_set.set_carry(joint, carry);
}

// Largest mass ratio for a correction of positions. Of chains with tips of up to 1:1e6 gaps are 0.1 % then,
// at 100 0.4 %, at 1000 1.3 %.
constexpr double kMostRatio = 10;

// Raises the masses of light bodies for a correction of positions, so that none moves far to spare a heavy
// one a short way.
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

// Takes the work that forces lose by the shifts that closed joints from the velocities against them, as far
// as there are any. `per_push` times what forces `push` in a substep is their acceleration. Otherwise what
// closing lifts would fall ever faster, and stay where it is.
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

// Fraction of joints' gaps that a correction closes, and the relative compliance of its rows.
struct Closing {
  double share = 0, softness = 0;
};

template <class Real>
Closing closing_of(const WorldData<Real>& w) {
  if (w.settings.solver == Solver::Direct) return {tuning::kDirectJointShare, tuning::kDirectCloseSoftness};
  return {tuning::kJointShare, tuning::kCloseSoftness};
}

// Makes the rows of a correction. Returns false if there is nothing to close: of joints (`joints`), or of
// contacts.
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

// Moves bodies to close a fraction of the gaps of joints, with limited mass ratios, and with them the bodies
// that press on them. Takes the work that this does against the forces from the velocities. `h`: s, length of
// the substep in which the forces act.
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

// Pushes overlapping bodies apart by a fraction of their overlaps, with their own masses, and with joints as
// they are. Were light bodies to lift heavy ones off others as far as they give way themselves, these would
// fall back upon them in the next step.
template <class Real>
void push_apart(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step) {
  if (!make_closing_rows(w, island, step, false, 4 * tuning::kPushShare)) return;
  island.system.correct(closing_of(w).softness);
  shift_links(w, island, tuning::kLinkTurn);
}

// ---- Motion

// Notes the poses of an island's bodies.
template <class Real>
void note_starts(const WorldData<Real>& w, JointedIsland<Real>& island) {
  note_poses(w, island);
  for (JointedLink& link : island.links)
    link.rotation_c = w.rotation[link.body].c, link.rotation_s = w.rotation[link.body].s;
}

// Moves an island's bodies back to the poses that were noted.
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

// Finds the impulses of a motion that begins at the noted poses with the velocities `before`, and its
// velocities. `velocity` has those without impulses, then those with them.
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

// Finds the impulses after a motion, with which velocities fit the constraints at the present poses.
template <class Real>
void relax(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step) {
  RowMaker<Real>(w, island, step, Stage::Relax).make();
  solve(island, false);
  for (std::size_t k = 0; k < island.links.size(); ++k) {
    const BoundedBody& body = island.system.bodies[k];
    island.links[k].velocity = body.velocity, island.links[k].spin = body.spin;
  }
}

// ---- Parts of a substep. Where light links turn far under a load, the drift of joints, of third order in h,
// is more than closing gaps can make up for.

// Drift of a row in a substep that is tolerated, as a fraction of its link. As each step of four substeps
// closes half of the gaps, they stay within 8 times of it.
constexpr double kDrift = 5e-4;
// Largest number of parts of a substep.
constexpr int kMostParts = 64;

// Calls `look(gap)` with the gap of each rigid row and each limit at the present poses, in kDrift.
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

// Returns the most by which the motion from the noted poses opens a gap, in kDrift; 0 if all gaps are small
// at its end. The bodies are at its end, and are put back.
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

// Moves an island from where it is through equal parts of a substep, each with its share of the forces. Its
// links have the velocities at the end then, and the mean ones of the last part.
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
    // Whole gaps at once would open joints again by ten times as much, as taut links turn far for little.
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

// Moves an island through a substep in as many parts as keep the drift small, from `drift`, that of the
// whole. The bodies are at its start, before and after. Ends where more parts do not halve the drift: it is
// none of the motion then, but of what contradicts the joints.
template <class Real>
void move_in_parts(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step,
                   double drift) {
  std::pmr::vector<JointedLink>& starts = island.starts;
  starts.assign(island.links.begin(), island.links.end());
  double before = std::numeric_limits<double>::infinity();
  for (int parts = 1; drift > 1 && drift < 0.5 * before && parts < kMostParts;) {
    // The drift decreases with the square of the number of parts, if it does: two parts show that.
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
      // A locked axis stands still from now on. Reflected at it, the others would follow what it had.
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
    if (last) find_carry(w, island);
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
