#include "engine/world/islands/direct_islands.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/union_find.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_passes.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/islands/hinge_trees.h"
#include "engine/world/islands/jointed_islands.h"
#include "engine/world/state/constants.h"

namespace plumb {
namespace {

// Returns a contact's hardness outside of direct islands.
template <class Real>
ContactHardness hardness_of(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  return w.is_dynamic(c.body_a) && w.is_dynamic(c.body_b) ? ContactHardness::Soft : ContactHardness::Stiff;
}

template <class Real>
bool is_outside_trees(const WorldData<Real>& w, const JointRecord& joint) {
  const bool a = w.is_dynamic(joint.body_a), b = w.is_dynamic(joint.body_b);
  return joint.active && (a || b) && !in_hinge_tree(w, a ? joint.body_a : joint.body_b);
}

// Returns the number of active joints that are not part of hinge trees.
template <class Real>
int joints_outside_trees(const WorldData<Real>& w) {
  return w.joint_set.active_count() - w.scratch.islands.trees.hinge_count;
}

// Returns true if an island with this number of rows is solved directly.
bool is_direct(int rows) {
  return enabled(Switch::DirectIslands) && rows > 2 && rows <= tuning::kMaxDirectRows;
}

// Values of island_size that mark an island with joints. It is solved by iterations (kIterated), as one
// system (kJointed), or as one system if that costs little (kJointedIfCheap).
constexpr int kIterated = tuning::kMaxSlenderRows + 1, kJointed = -1, kJointedIfCheap = -2;

constexpr bool is_jointed(int size) { return size == kJointed || size == kJointedIfCheap; }

// Returns true for islands of contacts that have too many of them to be solved directly, if all have rows.
// (A contact counts two rows, so kIterated is none of these.)
constexpr bool is_crowded(int size) { return size > tuning::kMaxDirectRows && size != kIterated; }

// Returns the separation, m, up to which a contact's points may press without a further approach. The margin
// of contacts is a fraction of the shapes' extents, so a thin sheet has contacts with several others above
// and below it. It can press only on the next ones.
template <class Real>
Real near_margin(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  Real margin = std::numeric_limits<Real>::max();
  for (const int body : {c.body_a, c.body_b})
    if (w.is_dynamic(body))
      margin = std::min({margin, Real(tuning::kSpeculativeMargin) * w.extents[body],
                         Real(2 * tuning::kNearThickness) * w.bodies[body].half_width});
  return margin;
}

// Returns true if a body has passed through a half of another. Rows that push it out of those beyond as well
// contradict each other.
template <class Real>
bool is_deep_in(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  Real half_width = std::numeric_limits<Real>::max();
  for (const int body : {c.body_a, c.body_b})
    if (w.is_dynamic(body)) half_width = std::min(half_width, w.bodies[body].half_width);
  return -std::min(c.separation[0], c.separation[c.count - 1]) > half_width;
}

// Returns how far the bodies approach at a point in the time dt, m, at their present velocities.
template <class Real>
Real approach_of(const WorldData<Real>& w, const ContactConstraint<Real>& c, int point, Real dt) {
  const SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Real speed = dot(c.normal, b.velocity - a.velocity) + c.arm_b[point] * b.angular_velocity -
                     c.arm_a[point] * a.angular_velocity;
  return std::max(-dt * speed, Real(0));
}

// Returns true if a point of a contact presses, or is near enough to press in this step.
template <class Real>
bool is_near(const WorldData<Real>& w, const ContactConstraint<Real>& c, int point, Real dt) {
  if (c.normal_impulse[point] > 0 || c.separation[point] <= 0) return true;
  return c.separation[point] <= near_margin(w, c) + approach_of(w, c, point, dt);
}

// Returns true for trees of a few similar hinges without contacts. Iterations are accurate enough for these,
// and cost less.
template <class Real>
bool left_to_iterations(const WorldData<Real>& w, int body) {
  const Scratch<Real>& s = w.scratch;
  return w.settings.solver != Solver::Direct && body < static_cast<int>(s.islands.not_a_tree.size()) &&
         s.islands.not_a_tree[s.islands.tree_root_of[body]] == kLeftToIterations;
}

// Prepares to hand joints over to the iterations: scales the impulses of the joints for which `left` returns
// true, and those of contacts at their bodies. The iterations start from them.
template <class Real, class Left>
void hand_over_joints(WorldData<Real>& w, const Left& left) {
  if (!enabled(Switch::HandingOver)) return;
  std::vector<Real>& warm_start_fraction = w.scratch.solver.warm_start_fraction;
  warm_start_fraction.clear();
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (!left(joint)) return;
    const Real fraction = w.joint_set.take_over(joint.slot);
    if (fraction == 1) return;
    if (warm_start_fraction.empty()) warm_start_fraction.assign(w.bodies.size(), 1);
    warm_start_fraction[joint.body_a] = warm_start_fraction[joint.body_b] = fraction;
  });
  if (warm_start_fraction.empty()) return;
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    const auto of = [&](int body) { return w.is_dynamic(body) ? warm_start_fraction[body] : Real(1); };
    scale_impulses(c, std::min(of(c.body_a), of(c.body_b)));
  });
}

// Keeps only the part of an island's impulses that balances a load if a driver pulls a load that is caught.
// Its rows press on both sides with many times the load. Contacts that are left to iterations in the next
// step, with or without the joint, would start from that: rooms of 15 boxes went from 25 to 6,000 m/s.
template <class Real>
void keep_loads(WorldData<Real>& w, JointedIsland<Real>& island) {
  if (std::none_of(island.links.begin(), island.links.end(), [](const JointedLink& k) { return k.yields; }))
    return;
  const Real fraction = static_cast<Real>(w.joint_set.warm_start_fraction(island.joints[0]));
  for (ContactConstraint<Real>* c : island.contacts) scale_impulses(*c, fraction);
  for (const int joint : island.joints) w.joint_set.take_over(joint);
}

// Chooses the islands with joints that are solved as one system. These are islands with few bounded rows and
// contacts, and islands with a large mass ratio; with Solver::Direct all.
template <class Real>
void choose_jointed(WorldData<Real>& w) {
  Scratch<Real>& s = w.scratch;
  s.islands.lightest.assign(w.bodies.size(), std::numeric_limits<Real>::max());
  s.islands.heaviest.assign(w.bodies.size(), 0);
  s.islands.island_joints.assign(w.bodies.size(), 0);
  s.islands.island_bounded_rows.assign(w.bodies.size(), 0);
  for (const int body : w.awake) {
    const Real mass = w.bodies[body].mass;
    if (!w.is_dynamic(body)) continue;
    const int root = s.islands.island_of[body];
    s.islands.lightest[root] = std::min(s.islands.lightest[root], mass),
    s.islands.heaviest[root] = std::max(s.islands.heaviest[root], mass);
    // A body has infinite mass along a locked axis, which the iterations of joints do not take into account.
    const BodyRecord<Real>& record = w.bodies[body];
    if (record.lock_x || record.lock_y) s.islands.heaviest[root] = std::numeric_limits<Real>::infinity();
  }
  const auto root_of = [&](const JointRecord& joint) {
    return s.islands.island_of[w.is_dynamic(joint.body_a) ? joint.body_a : joint.body_b];
  };
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (!is_outside_trees(w, joint)) return;
    const int root = root_of(joint);
    ++s.islands.island_joints[root];
    s.islands.island_bounded_rows[root] += w.joint_set.bounded_rows(joint.slot);
  });
  for (const int body : w.awake) {
    if (!w.is_dynamic(body) || s.islands.island_of[body] != body || s.islands.island_joints[body] == 0)
      continue;
    // Each contact counts two rows in island_size.
    const bool small = enabled(Switch::JointedIslands) &&
                       s.islands.island_joints[body] <= tuning::kMaxJointedJoints &&
                       s.islands.island_size[body] <= 2 * tuning::kMaxJointedContacts;
    const bool similar_masses =
        s.islands.heaviest[body] <= Real(tuning::kDirectMassRatio) * s.islands.lightest[body];
    const bool few = w.settings.integrator == Integrator::VelocityVerlet &&
                     s.islands.island_bounded_rows[body] <= tuning::kFewBoundedRows &&
                     s.islands.island_size[body] <= 2 * tuning::kFewContacts && !left_to_iterations(w, body);
    const bool always = !similar_masses || w.settings.solver == Solver::Direct;
    s.islands.island_size[body] = small && always ? kJointed : small && few ? kJointedIfCheap : kIterated;
  }
  // From here on: joints less bodies.
  for (const int body : w.awake)
    if (w.is_dynamic(body)) --s.islands.island_joints[s.islands.island_of[body]];
}

// Includes towers and other slender heaps of any height: if there are few loops, and few contacts on any
// body, the factorisation has linear cost. `contacts_of(body)` returns the number of a body's contacts, and
// `size_of(root)` the rows of an island, which it sets to what counts as small if the island is slender.
template <class Real, class ContactsOf, class SizeOf>
void choose_slender(WorldData<Real>& w, const ContactsOf& contacts_of, const SizeOf& size_of) {
  if (!enabled(Switch::SlenderIslands)) return;
  std::vector<int>& limits = w.scratch.islands.max_island_rows;
  limits.assign(w.bodies.size(), 2 * tuning::kMaxSlenderLoops);
  for (const int body : w.awake) {
    if (!w.is_dynamic(body)) continue;
    int& limit = limits[w.scratch.islands.island_of[body]];
    limit = contacts_of(body) > tuning::kMaxSlenderContacts ? -tuning::kMaxSlenderRows : limit + 2;
  }
  for (const int body : w.awake) {
    int& size = size_of(body);
    if (size > tuning::kMaxDirectRows && size <= tuning::kMaxSlenderRows && size <= limits[body])
      size = tuning::kMaxDirectRows;
  }
}

// Finds the islands, by their root body, and stores an upper bound of the rows of each in
// `w.scratch.islands.island_size`. Islands with more than tuning::kMaxDirectRows are solved by iterations
// alone.
template <class Real>
void find_islands(WorldData<Real>& w) {
  UnionFind islands(w.scratch.islands.island_of, w.bodies.size());
  const auto connect = [&](int a, int b) {
    if (w.is_dynamic(a) && w.is_dynamic(b)) islands.join(a, b);
  };
  w.graph.for_each([&](const ContactConstraint<Real>& c) { connect(c.body_a, c.body_b); });
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (is_outside_trees(w, joint)) connect(joint.body_a, joint.body_b);
  });
  w.scratch.islands.island_size.assign(w.bodies.size(), 0);
  w.scratch.islands.island_index.assign(w.bodies.size(), kNone);
  const auto count = [&](int a, int b, int rows) {
    w.scratch.islands.island_size[islands.find(w.is_dynamic(a) ? a : b)] += rows;
  };
  w.graph.for_each([&](const ContactConstraint<Real>& c) { count(c.body_a, c.body_b, 2); });
  for (const int body : w.awake) w.scratch.islands.island_of[body] = islands.find(body);
  choose_slender(
      w, [&](int body) { return w.bodies[body].constraints; },
      [&](int body) -> int& { return w.scratch.islands.island_size[body]; });
  if (joints_outside_trees(w) > 0) choose_jointed(w);
  const auto any = [&](const auto& test) {
    return std::any_of(w.awake.begin(), w.awake.end(),
                       [&](int body) { return test(w.scratch.islands.island_size[body]); });
  };
  w.scratch.islands.has_direct_islands = any([](int size) { return is_direct(size) || is_jointed(size); });
  w.scratch.islands.has_crowded_islands = enabled(Switch::DirectIslands) && any(is_crowded);
}

// Counts the rows of the points that are near enough to press, of the islands that have too many contacts.
// This is done in each step, since it depends on the motion. Returns true if some have few enough.
template <class Real>
bool choose_crowded(WorldData<Real>& w, Real dt) {
  Scratch<Real>& s = w.scratch;
  if (!s.islands.has_crowded_islands) return false;
  s.islands.near_rows.assign(w.bodies.size(), 0), s.islands.near_contacts.assign(w.bodies.size(), 0);
  // Number of islands that may still have few enough: a large heap is left after a part of its contacts.
  auto undecided = std::count_if(w.awake.begin(), w.awake.end(), [&](int body) {
    return s.islands.island_of[body] == body && is_crowded(s.islands.island_size[body]);
  });
  const auto add = [&](const ContactConstraint<Real>& c) {
    const int root = s.islands.island_of[w.is_dynamic(c.body_a) ? c.body_a : c.body_b];
    int& rows = s.islands.near_rows[root];
    if (!is_crowded(s.islands.island_size[root]) || rows > tuning::kMaxSlenderRows) return;
    if (!is_near(w, c, 0, dt) && !(c.count == 2 && is_near(w, c, 1, dt))) return;
    // Those with the ground close no loops of bodies.
    if (w.is_dynamic(c.body_a) && w.is_dynamic(c.body_b)) rows += is_deep_in(w, c) ? kIterated : 2;
    if (rows > tuning::kMaxSlenderRows) --undecided;
    ++s.islands.near_contacts[c.body_a], ++s.islands.near_contacts[c.body_b];
  };
  w.graph.for_each_colour([&](const std::vector<ContactConstraint<Real>>& colour, bool) {
    for (std::size_t i = 0; i < colour.size() && undecided > 0; ++i) add(colour[i]);
  });
  choose_slender(
      w, [&](int body) { return s.islands.near_contacts[body]; },
      [&](int body) -> int& { return s.islands.near_rows[body]; });
  return std::any_of(w.awake.begin(), w.awake.end(),
                     [&](int body) { return is_direct(s.islands.near_rows[body]); });
}

template <class Island, class Real>
Island& island_at(WorldData<Real>& w, std::vector<Island>& islands, int& count, int root) {
  int& index = w.scratch.islands.island_index[root];
  if (index == kNone) {
    index = count++;
    if (count > static_cast<int>(islands.size())) islands.emplace_back(&w.scratch.memory);
    islands[index].contacts.clear();
    islands[index].root = root;
  }
  return islands[index];
}

// Returns true if no contact of an island has an impulse: its bodies fly together, as a stack that falls.
template <class Real>
bool flies(const DirectIsland<Real>& island) {
  return std::none_of(island.contacts.begin(), island.contacts.end(), [](const ContactConstraint<Real>* c) {
    return c->normal_impulse[0] > 0 || c->normal_impulse[1] > 0;
  });
}

// Returns true if points meet in this step that were apart before: the island lands, or bodies on it do.
template <class Real>
bool lands(const WorldData<Real>& w, const DirectIsland<Real>& island, Real dt) {
  return std::any_of(island.contacts.begin(), island.contacts.end(), [&](const ContactConstraint<Real>* c) {
    const Real margin = near_margin(w, *c);
    for (int i = 0; i < c->count; ++i)
      if (c->separation[i] > margin && c->separation[i] <= margin + approach_of(w, *c, i, dt)) return true;
    return false;
  });
}

// Adds the rows of an island, and orders them. Of points where nothing presses yet, those have rows that are
// near, or all with `any_distance`. Returns true if the rows cost little enough.
template <class Real>
bool add_rows(const WorldData<Real>& w, DirectIsland<Real>& island, Real dt, bool any_distance) {
  std::pmr::vector<DirectRow<Real>>& rows = island.system.rows;
  rows.clear();
  const bool all_open = enabled(Switch::FlyingStacks) && flies(island);
  int block = 0;
  for (ContactConstraint<Real>* c : island.contacts) {
    const int before = static_cast<int>(rows.size());
    for (int i = 0; i < c->count; ++i) {
      // Points that are separated and have no impulse are left to the iterations. Where nothing presses yet,
      // the near ones have rows: a stack that lands in this step would have no floor in the system, and
      // hop. Points that will bounce are left to their impact.
      const bool has_row = all_open && !(c->restitution > 0) && (any_distance || is_near(w, *c, i, dt));
      if (!(c->mass[i] > 0)) continue;  // locked axes block it
      if (c->normal_impulse[i] == 0 && c->separation[i] > 0 && !has_row) continue;
      DirectRow<Real> row;
      row.a = c->body_a, row.b = c->body_b;
      row.linear_a = -free_of_a(c->normal, c->locks), row.linear_b = free_of_b(c->normal, c->locks);
      row.angular_a = -c->arm_a[i], row.angular_b = c->arm_b[i];
      row.impulse = &c->normal_impulse[i];
      row.unilateral = true;
      row.block = block;
      rows.push_back(row);
    }
    if (static_cast<int>(rows.size()) > before) ++block;
  }
  return island.system.order(w.motion.data()) <= tuning::kMaxDirectCost;
}

// Collects the contacts and joints of the chosen islands.
template <class Real>
void fill_islands(WorldData<Real>& w) {
  Scratch<Real>& s = w.scratch;
  const auto root_of = [&](int a, int b) { return s.islands.island_of[w.is_dynamic(a) ? a : b]; };
  const auto jointed_at = [&](int root) -> JointedIsland<Real>& {
    const bool is_new = s.islands.island_index[root] == kNone;
    JointedIsland<Real>& island = island_at(w, s.islands.jointed_islands, s.islands.jointed_count, root);
    if (is_new) island.joints.clear();
    return island;
  };
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    const int root = root_of(c.body_a, c.body_b), rows = s.islands.island_size[root];
    if (is_jointed(rows)) jointed_at(root).contacts.push_back(&c);
    if (is_direct(is_crowded(rows) && s.islands.has_crowded_islands ? s.islands.near_rows[root] : rows))
      island_at(w, s.islands.direct_islands, s.islands.direct_count, root).contacts.push_back(&c);
  });
  if (joints_outside_trees(w) == 0) return;
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (!is_outside_trees(w, joint)) return;
    const int root = root_of(joint.body_a, joint.body_b);
    if (is_jointed(s.islands.island_size[root])) jointed_at(root).joints.push_back(joint.slot);
  });
}

// Orders the rows of new islands with joints. Islands that would cost too much are left to the iterations
// until islands are searched again.
template <class Real>
void order_jointed(WorldData<Real>& w) {
  Scratch<Real>& s = w.scratch;
  int kept = 0;
  for (int i = 0; i < s.islands.jointed_count; ++i) {
    JointedIsland<Real>& island = s.islands.jointed_islands[i];
    int& size = s.islands.island_size[island.root];
    const double max_cost = size == kJointed ? tuning::kMaxJointedCost
                                             : tuning::kFewCost * static_cast<double>(island.joints.size());
    if (order_jointed_island(w, island) <= std::min(max_cost, tuning::kMaxJointedCost)) {
      if (kept != i) {
        std::swap(s.islands.jointed_islands[kept], island);
        s.islands.island_index[s.islands.jointed_islands[kept].root] = kept;
      }
      ++kept;
    } else {
      size = kIterated, s.islands.island_index[island.root] = kNone;
    }
  }
  s.islands.jointed_count = kept;
  s.islands.has_direct_islands = kept > 0 || s.islands.direct_count > 0;
}

// Hands the joints that are no longer solved with their island over to the iterations.
template <class Real>
void hand_over_unselected(WorldData<Real>& w) {
  hand_over_joints(w, [&](const JointRecord& joint) {
    const int body = w.is_dynamic(joint.body_a) ? joint.body_a : joint.body_b;
    return is_outside_trees(w, joint) &&
           !is_jointed(w.scratch.islands.island_size[w.scratch.islands.island_of[body]]);
  });
}

// Leaves an island to the iterations for the rest of the step.
template <class Real>
void solve_by_iterations(WorldData<Real>& w, DirectIsland<Real>& island) {
  for (ContactConstraint<Real>* c : island.contacts) c->hardness = hardness_of(w, *c);
  island.contacts.clear(), island.system.rows.clear();
}

template <class Real>
Real current_separation(const SolverBody<Real>* motion, const DirectRow<Real>& row, Real at_start) {
  const SolverBody<Real>&a = motion[row.a], &b = motion[row.b];
  return at_start + dot(row.linear_b, b.delta_position - a.delta_position) + row.angular_a * a.delta_angle +
         row.angular_b * b.delta_angle;
}

// Calls `act(island)` for the islands of contacts, in parallel: they have no dynamic body in common.
template <class Real, class Act>
void for_each_direct(WorldData<Real>& w, const Act& act) {
  constexpr int kIslandsPerTask = 2;
  w.scheduler.ranges(w.scratch.islands.direct_count, kIslandsPerTask, [&](int first, int last) {
    for (int i = first; i < last; ++i) act(w.scratch.islands.direct_islands[i]);
  });
}

}  // namespace

template <class Real>
void prepare_direct_islands(WorldData<Real>& w, Real dt) {
  w.scratch.islands.direct_count = w.scratch.islands.jointed_count = 0;
  const bool articulated = w.settings.solver == Solver::Direct;
  if (!articulated && !w.settings.direct_islands) return;
  if (w.graph.empty() && joints_outside_trees(w) == 0) return;
  const bool are_new = !w.scratch.islands.islands_known;
  if (are_new) find_islands(w);
  w.scratch.islands.islands_known = true;
  const bool has_crowded = choose_crowded(w, dt);
  if (w.scratch.islands.has_direct_islands || has_crowded) {
    fill_islands(w);
    if (are_new) order_jointed(w);
  }
  if (are_new && joints_outside_trees(w) > 0) hand_over_unselected(w);
  if (!w.scratch.islands.has_direct_islands && !has_crowded) return;
  for_each_direct(w, [&](DirectIsland<Real>& island) {
    // Gives all points rows if something lands, because it may close any gap above it. If those are too many,
    // the iterations find the impact: they would repeat impulses of a solution of the near ones.
    const bool any_distance = lands(w, island, dt);
    if (any_distance && is_crowded(w.scratch.islands.island_size[island.root]))
      return solve_by_iterations(w, island);
    if (!add_rows(w, island, dt, any_distance) && !(any_distance && add_rows(w, island, dt, false)))
      return solve_by_iterations(w, island);
    for (ContactConstraint<Real>* c : island.contacts) c->hardness = ContactHardness::Rigid;
    island.system.assemble(w.motion.data());
  });
  prepare_jointed_islands(w);
}

template <class Real>
void assemble_again(WorldData<Real>& w, const ContactConstraint<Real>& c) {
  Scratch<Real>& s = w.scratch;
  if (c.hardness != ContactHardness::Rigid) return;
  const int index = s.islands.island_index[s.islands.island_of[w.is_dynamic(c.body_a) ? c.body_a : c.body_b]];
  DirectIsland<Real>& island = s.islands.direct_islands[index];
  if (!add_rows(w, island, Real(0), true)) return solve_by_iterations(w, island);
  island.system.assemble(w.motion.data());
}

template <class Real>
void solve_direct_islands(WorldData<Real>& w, const ContactStep<Real>& step, bool use_bias) {
  if (w.scratch.islands.direct_count == 0) return;
  for_each_direct(w, [&](DirectIsland<Real>& island) {
    if (island.system.rows.empty()) return;  // solved by iterations
    std::size_t next = 0;
    for (ContactConstraint<Real>* c : island.contacts) {
      for (int k = 0; k < c->count; ++k) {
        if (next >= island.system.rows.size() || island.system.rows[next].impulse != &c->normal_impulse[k])
          continue;
        DirectRow<Real>& row = island.system.rows[next++];
        const Real s = current_separation(w.motion.data(), row, c->separation[k]);
        const Real rate = step.softness[static_cast<int>(ContactHardness::Rigid)][0].bias_rate;
        row.bias = s > 0      ? s * step.inverse_h
                   : use_bias ? std::max(rate * s, -c->depenetration_speed)
                              : Real(0);
      }
    }
    if (island.system.solve_impulses(w.motion.data(), use_bias)) {
      island.system.apply(w.motion.data());
    } else if (island.system.is_infeasible()) {
      solve_by_iterations(w, island);
    }
  });
}

template <class Real>
void hand_over_all(WorldData<Real>& w) {
  hand_over_joints(w, [](const JointRecord&) { return true; });
}

template <class Real>
void finish_direct_islands(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i)
    keep_loads(w, w.scratch.islands.jointed_islands[i]);
  for (int i = 0; i < w.scratch.islands.direct_count; ++i) {
    for (ContactConstraint<Real>* c : w.scratch.islands.direct_islands[i].contacts)
      c->hardness = hardness_of(w, *c);
    w.scratch.islands.island_index[w.scratch.islands.direct_islands[i].root] = kNone;
  }
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i)
    w.scratch.islands.island_index[w.scratch.islands.jointed_islands[i].root] = kNone;
}

#define PLUMB_FOR(Real)                                                                 \
  template void prepare_direct_islands(WorldData<Real>&, Real);                         \
  template void assemble_again(WorldData<Real>&, const ContactConstraint<Real>&);       \
  template void solve_direct_islands(WorldData<Real>&, const ContactStep<Real>&, bool); \
  template void hand_over_all(WorldData<Real>&);                                        \
  template void finish_direct_islands(WorldData<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
