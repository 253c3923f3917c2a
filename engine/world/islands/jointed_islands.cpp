#include "engine/world/islands/jointed_islands.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/linear_algebra/row_coupling.h"
#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/islands/friction_cones.h"
#include "engine/world/islands/island_links.h"
#include "engine/world/state/constants.h"

namespace plumb {
namespace {

enum class Stage { Hold, Close, Relax };

// Typical number of a contact's rows, to estimate the cost of the factorisation.
constexpr int kContactRows = 3;

BoundedRow::State state_of(double impulse, double lower, double upper) {
  if (impulse <= lower) return BoundedRow::kLower;
  return impulse >= upper ? BoundedRow::kUpper : BoundedRow::kFree;
}

// Computes the rows of an island at the current positions, for one stage of a substep.
template <class Real>
class RowMaker {
 public:
  RowMaker(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step, Stage stage)
      : w_(w), island_(island), h_(step.h), hold_(stage == Stage::Hold), close_(stage == Stage::Close) {}

  void make() {
    island_.system.rows.clear(), island_.ties.clear(), island_.cones.clear();
    // Friction holds loads as it came to do so. Joints alone share redundant loads evenly.
    remembers_ = hold_ && std::any_of(island_.contacts.begin(), island_.contacts.end(),
                                      [](const ContactConstraint<Real>* c) { return c->friction > 0; });
    for (block_ = 0; block_ < static_cast<int>(island_.joints.size()); ++block_)
      add_joint(island_.joints[block_]);
    island_.contact_row = static_cast<int>(island_.ties.size());
    for (std::size_t i = 0; i < island_.contacts.size(); ++i, ++block_)
      add_contact(*island_.contacts[i], island_.last[i]);
  }

 private:
  double velocity_along(const BoundedRow& row) const {
    const JointedLink &a = island_.links[row.a], &b = island_.links[row.b];
    return dot(row.linear_a, a.before) + row.angular_a * a.spin_before + dot(row.linear_b, b.before) +
           row.angular_b * b.spin_before;
  }

  // Returns the rate of a row's coordinate after the first solve.
  double held_along(const BoundedRow& row) const {
    const JointedLink &a = island_.links[row.a], &b = island_.links[row.b];
    return dot(row.linear_a, a.velocity) + row.angular_a * a.spin + dot(row.linear_b, b.velocity) +
           row.angular_b * b.spin;
  }

  // `applied` is the impulse of the first solve; the second one adds to it. `last` is the impulse that the
  // row had before the step.
  void add(BoundedRow& row, const RowTie<Real>& tie, double lower, double upper, double last) {
    const std::size_t place = island_.ties.size();
    if (close_) {
      const bool unilateral = lower == 0 && tie.first < 0;
      const bool pressed = unilateral && island_.impulses[place] > 0;
      add_closing(row, tie, unilateral ? row.gap < 0 || pressed : row.gap != 0 || rigid_, pressed,
                  unilateral ? upper : 0);
      return;
    }
    if (place >= island_.impulses.size()) island_.impulses.push_back(last);
    const double guess = island_.impulses[place], applied = hold_ ? 0 : guess;
    row.lower = lower - applied, row.upper = upper - applied;
    row.state = state_of(guess, lower, upper);
    row.impulse = remembers_ ? guess : 0;
    row.wanted -= row.compliance * applied;
    island_.system.rows.push_back(row);
    island_.ties.push_back(tie);
  }

  // Springs, motors and friction correct no positions. Unilateral rows that are open and have no impulse may
  // stay so, or close.
  void add_closing(BoundedRow row, const RowTie<Real>& tie, bool holds, bool pressed, double upper) {
    row.state = holds ? BoundedRow::kFree : BoundedRow::kLower;
    if (pressed) row.gap = std::min(row.gap, 0.0);
    row.upper = upper;
    row.compliance = row.coupled_compliance = 0;
    island_.system.rows.push_back(row);
    island_.ties.push_back(tie);
  }

  // Returns the target rate of a unilateral row with `gap`: as the mean of the displacement, or as the
  // velocity at its end. The latter closes no faster than it does already: impulses that are taken back until
  // a gap closes would gain energy.
  double closing(double gap, const BoundedRow& row) const {
    const double rate = -std::max(gap, 0.0) / h_;
    return hold_ ? 2 * rate - velocity_along(row) : std::max(rate, std::min(held_along(row), 0.0));
  }

  void add_joint(int joint) {
    std::vector<JointSolverRow<Real>>& rows = w_.scratch.joint_rows;
    rows.clear();
    w_.joint_set.solver_rows(joint, w_.solver_bodies(), rows);
    const auto [link_a, link_b] = island_.blocks[block_];
    for (const JointSolverRow<Real>& from : rows) {
      BoundedRow row{.a = link_a, .b = link_b};
      row.linear_a = from.row.linear_a.template as<double>(),
      row.linear_b = from.row.linear_b.template as<double>();
      row.angular_a = from.row.angular_a, row.angular_b = from.row.angular_b;
      row.block = block_;
      const double most = from.most, gap = from.row.residual;
      // Gap at the substep's start, from which springs pull and limits are measured.
      const double start = hold_ ? gap - 0.5 * h_ * moved_along(row) : gap;
      double lower = -most;
      rigid_ = from.role == RowRole::Rigid;
      switch (from.role) {
        case RowRole::Rigid:
          row.wanted = hold_ ? -velocity_along(row) : 0;
          row.gap = gap;
          break;
        case RowRole::Spring:
          row.compliance = from.compliance, row.coupled_compliance = from.coupled_compliance;
          row.wanted = -double(from.rate) * (hold_ ? start : start - h_ * moved_along(row));
          break;
        case RowRole::Limit:
          lower = 0;
          row.wanted = closing(start, row);
          row.gap = gap;
          break;
        case RowRole::Motor:
          row.wanted = from.speed;
          row.softening = kDriven;
          break;
      }
      add(row, {.impulse = from.impulse, .most = from.most, .pair = from.pair}, lower, most, *from.impulse);
      if (!hold_ && from.coupled_compliance != 0) {
        const std::size_t last = island_.ties.size() - 1;
        std::pmr::vector<BoundedRow>& all = island_.system.rows;
        all[last].wanted -= from.coupled_compliance * island_.impulses[last - 1];
        all[last - 1].wanted -= from.coupled_compliance * island_.impulses[last];
      }
    }
  }

  // Returns the rate at which a row's coordinate has changed in the substep, m/s.
  double moved_along(const BoundedRow& row) const {
    const JointedLink &a = island_.links[row.a], &b = island_.links[row.b];
    return dot(row.linear_a, a.way) + row.angular_a * a.turn + dot(row.linear_b, b.way) +
           row.angular_b * b.turn;
  }

  void add_contact(ContactConstraint<Real>& c, const LastImpulses& last) {
    const auto [link_a, link_b] = island_.blocks[block_];
    const BodyMotion<Real>&a = w_.motion[c.body_a], &b = w_.motion[c.body_b];
    const Vec2d n = c.normal.template as<double>(), t{n.y, -n.x};
    const auto along = [&](Vec2d d, Real arm_a, Real arm_b) {
      BoundedRow row{.a = link_a, .b = link_b};
      row.block = block_;
      row.linear_a = -d, row.linear_b = d, row.angular_a = -double(arm_a), row.angular_b = arm_b;
      return row;
    };
    const double closed = dot(n, (b.moved - a.moved).template as<double>());
    const int first = static_cast<int>(island_.system.rows.size());
    const double friction = std::min(double(c.friction), kSteepest);
    const bool rubs = friction > 0;
    BoundedRow tangent = along(t, c.arm_tangent_a, c.arm_tangent_b);
    const double sliding = hold_ ? velocity_along(tangent) : held_along(tangent);
    tangent.wanted = hold_ ? 2 * double(c.surface_speed) - sliding : double(c.surface_speed);
    const double slip = std::abs(sliding - double(c.surface_speed));
    const FrictionRays rays = rays_of(last, friction);
    double pressure = 0;
    rigid_ = false;
    for (int i = 0; i < c.count; ++i) {
      BoundedRow row = along(n, c.arm_a[i], c.arm_b[i]);
      const double gap =
          double(c.separation[i]) + closed + double(c.arm_b[i]) * b.turned - double(c.arm_a[i]) * a.turned;
      const double start = hold_ ? gap - 0.5 * h_ * moved_along(row) : gap;
      row.wanted = closing(start, row);
      row.gap = std::max(gap, -double(c.push_speed) * h_ / tuning::kPushShare);
      // A contact that bounces is disabled until its time of impact, and a gap that nothing pressed on brakes
      // nothing at the substep's end.
      const std::size_t place = island_.ties.size();
      const bool pressed =
          !hold_ && (island_.impulses[place] > 0 || (rubs && island_.impulses[place + 1] > 0));
      const bool open = !hold_ && !close_ && gap > 0 && !pressed;
      const bool passes = open || !(c.mass[i] > 0);
      const double most = passes ? 0 : std::numeric_limits<double>::infinity();
      for (int k = 0; k < (rubs ? 2 : 1); ++k) {
        const double slope = k == 0 ? friction : -friction;
        BoundedRow ray = row;
        if (close_) {
          // One of the two closes the gap.
          const bool holds = k == 0 && (row.gap < 0 || pressed);
          add_closing(ray, {.impulse = &c.normal_impulse[i]}, holds, holds && pressed, k == 0 ? most : 0);
          continue;
        }
        ray.linear_a += slope * tangent.linear_a, ray.linear_b += slope * tangent.linear_b;
        ray.angular_a += slope * tangent.angular_a, ray.angular_b += slope * tangent.angular_b;
        ray.wanted += slope * tangent.wanted - friction * slip * (hold_ ? 2 : 1);
        add(ray,
            {.impulse = &c.normal_impulse[i], .tangent = rubs ? &c.tangent_impulse : nullptr, .slope = slope},
            0, most, rubs ? rays.impulse[i][k] : last.normal[i]);
        if (passes) island_.impulses[island_.ties.size() - 1] = 0;
        pressure += island_.impulses[island_.ties.size() - 1];
      }
    }
    const int count = static_cast<int>(island_.system.rows.size()) - first;
    if (rubs) {
      const std::span<const BoundedBody> bodies = island_.system.bodies;
      const BoundedRow normal = along(n, c.arm_a[0], c.arm_b[0]);
      const double across = coupling(bodies, tangent, tangent), through = coupling(bodies, normal, normal);
      const double gain = through > 0 ? 1 + friction * friction * across / through : 1;
      island_.cones.push_back({&c, block_, first, count, friction, slip, gain, 0});
    }
    if (c.rolling_arm > 0) {
      BoundedRow row = along({}, 1, 1);
      row.wanted = hold_ ? -velocity_along(row) : 0;
      const double most = c.rolling_arm * pressure;
      add(row, {.impulse = &c.rolling_impulse, .first = first, .count = count, .factor = c.rolling_arm},
          -most, most, last.rolling);
    }
  }

  // Largest coefficient of friction that counts, an angle of 89.4 degrees. The steeper the rays of a cone,
  // the more they depend on each other: at 1,000 normals err by 0.1 of their impulse.
  static constexpr double kSteepest = 100;
  // Compliance of motors relative to their mobility: limits and rigid rows prevail over them.
  static constexpr double kDriven = 1e-6;

  WorldData<Real>& w_;
  JointedIsland<Real>& island_;
  const double h_;
  const bool hold_, close_;
  int block_ = 0;
  bool rigid_ = false, remembers_ = false;
};

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

// Moves bodies to close a fraction of the gaps.
template <class Real>
void close_gaps(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step) {
  RowMaker<Real>(w, island, step, Stage::Close).make();
  BoundedRows& system = island.system;
  const bool direct = w.settings.solver == Solver::Direct;
  const double joint_share = direct ? tuning::kDirectJointShare : tuning::kJointShare;
  for (std::size_t i = 0; i < system.rows.size(); ++i) {
    BoundedRow& row = system.rows[i];
    if (row.state != BoundedRow::kFree) continue;
    row.gap *= static_cast<int>(i) >= island.contact_row ? 4 * tuning::kPushShare : joint_share;
  }
  system.correct(direct ? tuning::kDirectCloseSoftness : tuning::kCloseSoftness);
  shift_links(w, island, tuning::kLinkTurn);
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
  const double h = step.h;
  for (int i = 0; i < w.scratch.jointed_count; ++i) {
    JointedIsland<Real>& island = w.scratch.jointed[i];
    for (JointedLink& link : island.links) {
      BodyMotion<Real>& motion = w.motion[link.body];
      link.moved = motion.moved.template as<double>(), link.turned = motion.turned;
      link.rotation_c = w.rotation[link.body].c, link.rotation_s = w.rotation[link.body].s;
      link.way = link.before, link.turn = link.spin_before;
    }
    for (const JointedLink& link : island.links) shift(w, link.body, 0.5 * h * link.way, 0.5 * h * link.turn);
    RowMaker<Real>(w, island, step, Stage::Hold).make();
    solve(island, true);
    for (std::size_t k = 0; k < island.links.size(); ++k) {
      JointedLink& link = island.links[k];
      const BoundedBody& body = island.system.bodies[k];
      BodyMotion<Real>& motion = w.motion[link.body];
      motion.moved = link.moved.template as<Real>(), motion.turned = static_cast<Real>(link.turned);
      w.rotation[link.body] = {static_cast<Real>(link.rotation_c), static_cast<Real>(link.rotation_s)};
      link.way = 0.5 * (link.before + body.velocity), link.turn = 0.5 * (link.spin_before + body.spin);
    }
    for (std::size_t k = 0; k < island.links.size(); ++k) {
      JointedLink& link = island.links[k];
      link.push = link.velocity - link.before, link.twist = link.spin - link.spin_before;
      link.velocity = island.system.bodies[k].velocity, link.spin = island.system.bodies[k].spin;
      put_velocity(w.motion[link.body], link.way, link.turn);
    }
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
    if (close) close_gaps(w, island, step);
    RowMaker<Real>(w, island, step, Stage::Relax).make();
    solve(island, false);
    for (std::size_t k = 0; k < island.links.size(); ++k) {
      const BoundedBody& body = island.system.bodies[k];
      put_velocity(w.motion[island.links[k].body], body.velocity, body.spin);
    }
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
