#include "engine/world/islands/direct_islands.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_passes.h"
#include "engine/world/contact_solver/contact_rows.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/islands/hinge_trees.h"
#include "engine/world/islands/island_choice.h"
#include "engine/world/islands/jointed_islands.h"
#include "engine/world/state/constants.h"

namespace plumb {
namespace {

// Returns a contact's hardness outside of direct islands.
template <class Real>
ContactHardness hardness_of(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  if (is_driven(c)) return ContactHardness::Driven;
  return w.is_dynamic(c.body_a) && w.is_dynamic(c.body_b) ? ContactHardness::Soft : ContactHardness::Stiff;
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
  assert(!island.joints.empty());  // drivers without joints are not in such islands
  const Real fraction = static_cast<Real>(w.joint_set.warm_start_fraction(island.joints[0]));
  for (ContactConstraint<Real>* c : island.contacts) scale_impulses(*c, fraction);
  for (const int joint : island.joints) w.joint_set.take_over(joint);
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
      if (is_driven(*c)) row.softening = float(kDrivenCompliance);
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

// Makes systems of the islands of contacts whose normals and friction must be solved together.
template <class Real>
void choose_systems(WorldData<Real>& w, Real dt) {
  Scratch<Real>& s = w.scratch;
  for (int i = 0; i < s.islands.direct_count; ++i) {
    DirectIsland<Real>& direct = s.islands.direct_islands[i];
    if (!needs_one_system(w, direct, dt)) continue;
    s.islands.island_index[direct.root] = kNone;
    JointedIsland<Real>& island =
        island_at(w, s.islands.jointed_islands, s.islands.jointed_count, direct.root);
    island.joints.clear();
    island.contacts.swap(direct.contacts);
    if (order_jointed_island(w, island) <= tuning::kFewCost * static_cast<double>(island.contacts.size()))
      continue;
    island.contacts.swap(direct.contacts);
    --s.islands.jointed_count, s.islands.island_index[direct.root] = i;
  }
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

// Sets the loads that the rows of a driven contact bear without yielding, no more than what the contact would
// bear if nothing else held its bodies: an impact ends within the step for whose whole length its load is
// known.
template <class Real>
void set_loads(WorldData<Real>& w, ContactConstraint<Real>& c, DirectRow<Real>* const (&rows)[2]) {
  const Real p = c.normal_impulse[0], q = c.normal_impulse[1];
  const Real target[2] = {rows[0] ? -rows[0]->bias : Real(0), rows[1] ? -rows[1]->bias : Real(0)};
  const std::array<Real, 2> by =
      ContactPair<Real>(w.motion.data(), c).normal_block(target, rows[0], rows[1], p, q);
  if (rows[0]) rows[0]->load = std::min(c.load_estimate[0], p + by[0]);
  if (rows[1]) rows[1]->load = std::min(c.load_estimate[1], q + by[1]);
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
    choose_systems(w, dt);
  }
  if (are_new && joints_outside_trees(w) > 0) hand_over_unselected(w);
  if (!w.scratch.islands.has_direct_islands && !has_crowded) return;
  for_each_direct(w, [&](DirectIsland<Real>& island) {
    if (island.contacts.empty()) return island.system.rows.clear();  // it has become a system
    // Gives all points rows if something lands, because it may close any gap above it. If those are too many,
    // the iterations find the impact: they would repeat impulses of a solution of the near ones.
    const bool any_distance = lands(w, island, dt);
    if (any_distance && is_crowded(w.scratch.islands.island_size[island.root]))
      return solve_by_iterations(w, island);
    if (!add_rows(w, island, dt, any_distance) && !(any_distance && add_rows(w, island, dt, false)))
      return solve_by_iterations(w, island);
    for (ContactConstraint<Real>* c : island.contacts)
      c->hardness = is_driven(*c) ? ContactHardness::DrivenRigid : ContactHardness::Rigid;
    island.system.assemble(w.motion.data());
  });
  prepare_jointed_islands(w);
}

template <class Real>
void renew_island_of(WorldData<Real>& w, const ContactConstraint<Real>& c) {
  IslandScratch<Real>& s = w.scratch.islands;
  if (s.direct_count == 0 && s.jointed_count == 0) return;
  const int root = s.island_of[w.is_dynamic(c.body_a) ? c.body_a : c.body_b], index = s.island_index[root];
  if (index == kNone) return;
  if (index < s.jointed_count && s.jointed_islands[index].root == root)
    return load_impulses(s.jointed_islands[index]);
  if (!is_rigid(c)) return;
  DirectIsland<Real>& island = s.direct_islands[index];
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
      DirectRow<Real>* of_point[2] = {};
      for (int k = 0; k < c->count; ++k) {
        if (next >= island.system.rows.size() || island.system.rows[next].impulse != &c->normal_impulse[k])
          continue;
        DirectRow<Real>& row = island.system.rows[next++];
        of_point[k] = &row;
        const Real s = current_separation(w.motion.data(), row, c->separation[k]);
        const Real rate = step.softness[static_cast<int>(ContactHardness::Rigid)][0].bias_rate;
        row.bias = s > 0      ? s * step.inverse_h
                   : use_bias ? std::max(rate * s, -c->depenetration_speed)
                              : Real(0);
      }
      if (is_driven(*c)) set_loads(w, *c, of_point);
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
  template void renew_island_of(WorldData<Real>&, const ContactConstraint<Real>&);      \
  template void solve_direct_islands(WorldData<Real>&, const ContactStep<Real>&, bool); \
  template void hand_over_all(WorldData<Real>&);                                        \
  template void finish_direct_islands(WorldData<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
