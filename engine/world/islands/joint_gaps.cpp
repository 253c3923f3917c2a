#include "engine/world/islands/joint_gaps.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/islands/island_links.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

// Mechanisms with more loops than this are not closed. A net of 8 x 8 bodies jointed to their neighbours
// has 49. The cost grows with the square of the number of loops; a net of 30 x 30 is open in each step, and
// closing it would double the cost of its step.
constexpr int kMaxLoops = 64;

// A joint is closed if its gap exceeds this fraction of its link (joint_opening.h), and one step has opened
// it by as much. Gaps that a persistent load keeps open are left: after each correction they would open
// again, and a lying ragdoll would creep without end. At 0.007, 270 of 2,000 random
// mechanisms open by more than 1 % of their shortest link (557 without closing), at 0.004 193. When all gaps
// were closed, propellers of long blades lost more than 2 % of their energy in 3 s with one substep per step
// at 0.005; this was not measured with the present rule.
constexpr double kMaxGap = 0.007;
// Fraction of Coulomb's bound below which the friction of a contact counts as sticking: impulses that are at
// the bound differ from it by rounding.
constexpr float kStickFraction = 0.999f;

// Rounds of closing.
constexpr int kCloseRounds = 4;

// Number of substeps from which kMaxGap holds; with fewer, joints may open by proportionally more.
// Otherwise, long blades would open in each step of 1/60 s, and closing them each time would take their spin.
constexpr int kReferenceSubsteps = 4;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// Marks of a joint, by slot.
enum : char { kNotOpen, kOpen, kCollected };

// Level of the rows: position-level rows close gaps, velocity-level rows keep them closed.
enum class Level { Position, Velocity };

// A mechanism (bodies that joints connect) whose gaps are being closed.
template <class Real>
class Mechanism {
 public:
  Mechanism(WorldData<Real>& w, JointedIsland<Real>& island, double h, int substeps, double max_gap)
      : w_(w), island_(island), h_(h), substeps_(substeps), max_gap_(max_gap) {}

  // Returns true if the step has opened the joint. Costs much less than `collect`.
  bool has_opened(int joint) {
    clear_constraints();
    island_.joints.push_back(joint);
    find_links(w_, island_);
    return has_opened();
  }

  // Collects all joints that are connected to a joint through dynamic bodies. Returns false if they have too
  // many loops.
  bool collect(int joint) {
    std::vector<char>& marks = w_.scratch.islands.open_joints;
    clear_constraints();
    clear_links(w_, island_);
    const auto add = [&](int slot) {
      if (marks[slot] == kCollected) return;
      marks[slot] = kCollected;
      island_.joints.push_back(slot);
    };
    add(joint);
    for (std::size_t next = 0; next < island_.joints.size(); ++next) {
      const auto [a, b] = w_.joint_set.bodies(island_.joints[next]);
      const std::size_t known = island_.links.size();
      const int link_a = link_at(w_, island_, a);
      island_.blocks.emplace_back(link_a, link_at(w_, island_, b));
      for (std::size_t link = known; link < island_.links.size(); ++link) {
        const int body = island_.links[link].body;
        if (!w_.is_dynamic(body)) continue;
        for_each_edge(w_.joints, w_.bodies[body].first_joint, [&](int, const JointRecord& record) {
          if (record.active) add(record.slot);
        });
      }
    }
    joined_count_ = island_.links.size();
    return static_cast<int>(island_.joints.size() - joined_count_) <= kMaxLoops;
  }

  void close() {
    make_joint_rows(Level::Position);
    collect_contacts();
    find_link_groups(w_, island_);
    if (order() > tuning::kMaxJointedCost) return;
    for (int round = 0; round < kCloseRounds; ++round) {
      if (round > 0) make_joint_rows(Level::Position);
      if (round > 0 && !is_open()) break;
      make_contact_rows(Level::Position);
      correct_positions();
    }
    project_velocities();
  }

 private:
  void clear_constraints() { island_.joints.clear(), island_.contacts.clear(); }

  // Adds the contacts of the mechanism's bodies. Other bodies at these contacts stay where they are.
  void collect_contacts() {
    for (std::size_t link = 0; link < joined_count_; ++link) {
      const int body = island_.links[link].body;
      if (!w_.is_dynamic(body)) continue;
      for_each_edge(w_.contacts, w_.bodies[body].first_contact, [&](int edge, const ContactRecord& record) {
        if (record.home != ContactHome::Graph) return;
        const int other = (edge & 1) != 0 ? record.body_a : record.body_b;
        const int index = link_at(w_, island_, other);
        const bool joined = index < static_cast<int>(joined_count_);
        if (joined && (edge & 1) != 0) return;  // added from its other body
        if (!joined) island_.system.bodies[index] = {};
        island_.contacts.push_back(&constraint_of(w_, record));
        const int own = static_cast<int>(link);
        island_.blocks.emplace_back((edge & 1) != 0 ? index : own, (edge & 1) != 0 ? own : index);
      });
    }
  }

  // Finds an elimination order; returns the cost of elimination in that order.
  double order() {
    island_.block_sizes.assign(island_.blocks.size(), 0);
    for (const BoundedRow& row : island_.system.rows) ++island_.block_sizes[row.block];
    for (std::size_t i = 0; i < island_.contacts.size(); ++i)
      island_.block_sizes[island_.joints.size() + i] =
          island_.contacts[i]->count + static_cast<int>(sticks(*island_.contacts[i]));
    return island_.system.order(island_.blocks, island_.block_sizes);
  }

  // Adds a joint's rows: rigid ones, limits, and motors, whose coordinate must not change. If an angle was
  // beyond a limit when the step began, another stage corrects it, so here its limit only prevents further
  // rotation.
  void make_joint_rows(Level level) {
    island_.system.rows.clear(), island_.row_sources.clear(), island_.max_gaps.clear();
    std::vector<JointSolverRow<Real>>& rows = w_.scratch.solver.joint_rows;
    for (int block = 0; block < static_cast<int>(island_.joints.size()); ++block) {
      rows.clear();
      w_.joint_set.solver_rows(island_.joints[block], w_.solver_bodies(), rows);
      const bool turns_back =
          w_.joint_set.began_beyond_limits(island_.joints[block], Real(2 * tuning::kLimitSlack));
      for (const JointSolverRow<Real>& from : rows) {
        if (from.role == RowRole::Spring) continue;
        if (from.role == RowRole::Motor && level == Level::Velocity) continue;
        BoundedRow row = joint_row(from, block);
        island_.row_sources.push_back({.impulse = from.impulse});
        island_.max_gaps.push_back(max_gap_ * link_length(island_, row, from.length));
        double gap = from.role == RowRole::Motor ? 0 : double(from.row.residual);
        if (turns_back && from.role == RowRole::Limit && is_angular(row)) gap = std::max(gap, 0.0);
        from.role == RowRole::Limit ? add_one_sided(row, gap, level) : add_rigid(row, gap, level);
      }
    }
  }

  BoundedRow joint_row(const JointSolverRow<Real>& from, int block) const {
    BoundedRow row{.a = island_.blocks[block].first, .b = island_.blocks[block].second};
    row.linear_a = from.row.linear_a.template as<double>();
    row.linear_b = from.row.linear_b.template as<double>();
    row.angular_a = from.row.angular_a, row.angular_b = from.row.angular_b;
    row.block = block;
    return row;
  }

  // Returns true if friction holds a contact. Closing gaps must not slide it either: a lying ragdoll whose
  // joints open in each step would crawl.
  static bool sticks(const ContactConstraint<Real>& c) {
    const Real max_friction = c.friction * normal_sum(c);
    return max_friction > 0 && std::abs(c.tangent_impulse) < kStickFraction * max_friction;
  }

  void make_contact_rows(Level level) {
    int block = static_cast<int>(island_.joints.size());
    for (ContactConstraint<Real>* c : island_.contacts) {
      const auto [link_a, link_b] = island_.blocks[block];
      if (island_.links[link_a].rigid_group == island_.links[link_b].rigid_group) {
        ++block;
        continue;
      }
      const SolverBody<Real>&a = w_.motion[c->body_a], &b = w_.motion[c->body_b];
      const Vec2d n = c->normal.template as<double>();
      const double closed = dot(n, (b.delta_position - a.delta_position).template as<double>());
      for (int i = 0; i < c->count; ++i) {
        BoundedRow row{.a = island_.blocks[block].first, .b = island_.blocks[block].second};
        row.linear_a = -n, row.linear_b = n;
        row.angular_a = -double(c->arm_a[i]), row.angular_b = c->arm_b[i];
        row.block = block;
        const double gap = double(c->separation[i]) + closed + double(c->arm_b[i]) * b.delta_angle -
                           double(c->arm_a[i]) * a.delta_angle;
        island_.row_sources.push_back({.impulse = &c->normal_impulse[i]});
        add_one_sided(row, std::max(gap, 0.0), level);
      }
      if (level == Level::Position && sticks(*c)) {
        BoundedRow row{.a = island_.blocks[block].first, .b = island_.blocks[block].second};
        row.linear_b = {n.y, -n.x}, row.linear_a = -row.linear_b;
        row.angular_a = -double(c->arm_tangent_a), row.angular_b = c->arm_tangent_b;
        row.block = block;
        row.lower = -kUnbounded, row.upper = kUnbounded;
        island_.row_sources.push_back({.impulse = &c->tangent_impulse});
        push_row(row, level);
      }
      ++block;
    }
  }

  void add_rigid(BoundedRow row, double gap, Level level) {
    row.gap = gap;
    row.target = level == Level::Position ? -gap : 0;
    row.lower = -kUnbounded, row.upper = kUnbounded;
    row.state = BoundedRow::kFree;
    push_row(row, level);
  }

  // Adds a unilateral row. A gap may close. A velocity may remain that closes it faster than the next substep
  // allows.
  void add_one_sided(BoundedRow row, double gap, Level level) {
    row.gap = std::min(gap, 0.0);
    row.target = level == Level::Position ? -gap : std::min(-std::max(gap, 0.0) / h_, 0.0);
    if (level == Level::Velocity) row.target = std::min(row.target, rate_of(row));
    row.lower = 0, row.upper = kUnbounded;
    row.state = row.gap < 0 ? BoundedRow::kFree : BoundedRow::kLower;
    push_row(row, level);
  }

  void push_row(BoundedRow& row, Level level) {
    if (level == Level::Position) row.softening = tuning::kCorrectionSoftness;
    island_.system.rows.push_back(row);
  }

  double rate_of(const BoundedRow& row) const {
    const auto along = [&](int link, Vec2d linear, double angular) {
      const SolverBody<Real>& motion = w_.motion[island_.links[link].body];
      return dot(linear, motion.velocity.template as<double>()) + angular * double(motion.angular_velocity);
    };
    return along(row.a, row.linear_a, row.angular_a) + along(row.b, row.linear_b, row.angular_b);
  }

  // Returns true if a joint's row is open by more than is allowed. Limits of angles are excluded, because
  // another stage turns them back.
  bool is_open(std::size_t i) const {
    const BoundedRow& row = island_.system.rows[i];
    return !is_angular_limit(row) && std::abs(row.gap) > island_.max_gaps[i];
  }
  bool is_open() const {
    for (std::size_t i = 0; i < island_.max_gaps.size(); ++i)
      if (is_open(i)) return true;
    return false;
  }

  static bool is_angular(const BoundedRow& row) { return row.linear_b == Vec2d{}; }
  static bool is_angular_limit(const BoundedRow& row) { return row.lower == 0 && is_angular(row); }

  // Returns true if the step has opened a row by more than the allowed gap. Earlier gaps are left to the
  // solver, because a load may keep them open.
  bool has_opened() {
    save_displacements(w_, island_);
    for (const JointedLink& link : island_.links)
      displace_body(w_, link.body, -link.delta_position, -link.delta_angle);
    make_joint_rows(Level::Position);
    std::pmr::vector<double>& before = island_.impulses;
    before.clear();
    for (const BoundedRow& row : island_.system.rows) before.push_back(std::abs(row.gap));
    for (const JointedLink& link : island_.links)
      displace_body(w_, link.body, link.delta_position, link.delta_angle);
    make_joint_rows(Level::Position);
    assert(before.size() == island_.system.rows.size());
    for (std::size_t i = 0; i < before.size(); ++i)
      if (is_open(i) && std::abs(island_.system.rows[i].gap) > before[i] + island_.max_gaps[i]) return true;
    return false;
  }

  void correct_positions() {
    BoundedRows& system = island_.system;
    for (BoundedBody& body : system.bodies) body.velocity = {}, body.spin = 0;
    system.solve();
    system.displacements.clear();
    for (const BoundedBody& body : system.bodies) system.displacements.push_back({body.velocity, body.spin});
    displace_links(w_, island_, tuning::kMaxCorrectionRotation);
  }

  // Removes the part of the velocities that opens the joints. It is a projection in the metric of the masses
  // onto a set that contains rest, so it adds no energy.
  void project_velocities() {
    BoundedRows& system = island_.system;
    make_joint_rows(Level::Velocity), make_contact_rows(Level::Velocity);
    const auto energy = [&] {
      double sum = 0;
      for (const BoundedBody& body : system.bodies) sum += energy_of(body);
      return sum;
    };
    for (std::size_t i = 0; i < island_.links.size(); ++i) {
      const SolverBody<Real>& motion = w_.motion[island_.links[i].body];
      system.bodies[i].velocity = motion.velocity.template as<double>();
      system.bodies[i].spin = motion.angular_velocity;
    }
    const double before = energy();
    system.solve();
    if (energy() > before) return;  // a moving body beside it pushes it: keep the velocities
    for (std::size_t i = 0; i < joined_count_; ++i) {
      SolverBody<Real>& motion = w_.motion[island_.links[i].body];
      if (!is_dynamic(motion)) continue;
      motion.velocity = system.bodies[i].velocity.template as<Real>();
      motion.angular_velocity = static_cast<Real>(system.bodies[i].spin);
    }
    carry_impulses();
  }

  // Adds to the impulses of joints and contacts, from which the next substep starts, what the projection has
  // found missing: its mean over the substeps. A persistent load is then carried by impulses, not by closing
  // its gaps in each step, which would leave the joints' forces too small and a lying ragdoll creeping. Only
  // the fraction is added that brings the impulses closest to balancing the forces: of impulses that have
  // stopped a shock, next to nothing. Contacts between dynamic bodies get none: those with bodies outside the
  // mechanism, which the projection takes as fixed, would make two mechanisms push each other ever harder;
  // those within it, where joints keep bodies overlapped, would press on contact and joints without end.
  void carry_impulses() {
    BoundedRows& system = island_.system;
    assert(island_.row_sources.size() == system.rows.size());
    add_loads();
    if (!enabled(Switch::CarriedImpulses)) return;
    island_.impulses.clear();
    const auto is_dynamic = [&](int link) { return w_.is_dynamic(island_.links[link].body); };
    for (const BoundedRow& row : system.rows) {
      const bool is_contact = row.block >= static_cast<int>(island_.joints.size());
      const bool carried = !is_contact || !is_dynamic(row.a) || !is_dynamic(row.b);
      island_.impulses.push_back(carried ? row.impulse / substeps_ : 0);
    }
    load_imbalance();
    const double fraction = system.best_load_fraction(island_.impulses);
    for (std::size_t i = 0; i < island_.impulses.size(); ++i)
      *island_.row_sources[i].impulse += static_cast<Real>(fraction * island_.impulses[i]);
  }

  // Adds the impulses of the projection to the loads of the joints.
  void add_loads() {
    const JointStep<Real> step{.inverse_dt = static_cast<Real>(1 / (h_ * substeps_))};
    std::size_t next = 0;
    for (int block = 0; block < static_cast<int>(island_.joints.size()); ++block) {
      const int joint = island_.joints[block];
      const Vec2d arm = w_.joint_set.anchor_arm(joint, w_.solver_bodies()).template as<double>();
      Vec2d impulse{};
      double moment = 0;
      for (; next < island_.system.rows.size() && island_.system.rows[next].block == block; ++next) {
        const BoundedRow& row = island_.system.rows[next];
        impulse += row.impulse * row.linear_b;
        moment += row.impulse * (row.angular_b - cross(arm, row.linear_b));
      }
      w_.joint_set.add_impulse(joint, impulse.template as<Real>(), static_cast<Real>(moment), step);
    }
  }

  // Sets the velocities of the system's bodies to what a substep's forces and present impulses change them
  // by, together.
  void load_imbalance() {
    BoundedRows& system = island_.system;
    for (BoundedBody& body : system.bodies) body.velocity = {}, body.spin = 0;
    for (std::size_t i = 0; i < joined_count_; ++i) {
      const VelocityIncrement<Real> increment = velocity_increment_of(w_, island_.links[i].body, h_);
      system.bodies[i].velocity = increment.velocity.template as<double>();
      system.bodies[i].spin = increment.spin;
    }
    std::vector<JointSolverRow<Real>>& rows = w_.scratch.solver.joint_rows;
    for (int block = 0; block < static_cast<int>(island_.joints.size()); ++block) {
      rows.clear();
      w_.joint_set.solver_rows(island_.joints[block], w_.solver_bodies(), rows);
      for (const JointSolverRow<Real>& from : rows)
        system.apply_impulse(joint_row(from, block), double(*from.impulse));
    }
    int block = static_cast<int>(island_.joints.size());
    for (const ContactConstraint<Real>* c : island_.contacts) {
      const Vec2d n = c->normal.template as<double>(), t{n.y, -n.x};
      const auto apply = [&](Vec2d along, double arm_a, double arm_b, double impulse) {
        BoundedRow row{.a = island_.blocks[block].first, .b = island_.blocks[block].second};
        row.linear_a = -along, row.linear_b = along, row.angular_a = -arm_a, row.angular_b = arm_b;
        system.apply_impulse(row, impulse);
      };
      for (int i = 0; i < c->count; ++i) apply(n, c->arm_a[i], c->arm_b[i], c->normal_impulse[i]);
      apply(t, c->arm_tangent_a, c->arm_tangent_b, c->tangent_impulse);
      apply({}, 1, 1, c->rolling_impulse);
      ++block;
    }
  }

  static double energy_of(const BoundedBody& body) {
    const Vec2d m = body.inverse_mass, v = body.velocity;
    return (m.x > 0 ? v.x * v.x / m.x : 0) + (m.y > 0 ? v.y * v.y / m.y : 0) +
           (body.inverse_inertia > 0 ? body.spin * body.spin / body.inverse_inertia : 0);
  }

  WorldData<Real>& w_;
  JointedIsland<Real>& island_;
  const double h_, substeps_, max_gap_;
  std::size_t joined_count_ = 0;  // number of links that joints connect; bodies in contact follow them
};

// Returns true if the island of a joint is known to have too many loops.
template <class Real>
bool has_many_loops(const WorldData<Real>& w, int joint) {
  if (!w.scratch.islands.islands_known) return false;
  const auto [a, b] = w.joint_set.bodies(joint);
  return w.scratch.islands.island_joints[w.scratch.islands.island_of[w.is_dynamic(a) ? a : b]] > kMaxLoops;
}

}  // namespace

template <class Real>
void close_joint_gaps(WorldData<Real>& w, double h, int substeps) {
  if (!enabled(Switch::JointGaps)) return;
  if (!w.settings.direct_islands && w.settings.solver != Solver::Direct) return;
  std::vector<char>& marks = w.scratch.islands.open_joints;
  marks.assign(static_cast<std::size_t>(w.joint_set.slots()), kNotOpen);
  const double max_gap = kMaxGap * std::max(kReferenceSubsteps / static_cast<double>(substeps), 1.0);
  if (!w.joint_set.find_open(w.solver_bodies(), static_cast<Real>(max_gap), marks, &w.scheduler)) return;
  Mechanism<Real> mechanism(w, w.scratch.islands.open_mechanism, h, substeps, max_gap);
  for (int joint = 0; joint < static_cast<int>(marks.size()); ++joint) {
    if (marks[joint] != kOpen || has_many_loops(w, joint)) continue;
    if (mechanism.has_opened(joint) && mechanism.collect(joint)) mechanism.close();
  }
}

template void close_joint_gaps(WorldData<float>&, double, int);
template void close_joint_gaps(WorldData<double>&, double, int);

}  // namespace plumb
