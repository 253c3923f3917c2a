#include "engine/world/direct_islands.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/constants.h"
#include "engine/world/free_motion.h"
#include "engine/world/hinge_trees.h"
#include "engine/world/link_gaps.h"
#include "engine/world/link_inertia.h"
#include "engine/world/union_find.h"

namespace plumb {
namespace {

// A contact's own hardness, outside of direct islands.
template <class Real>
ContactHardness hardness_of(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  return w.gives_way(c.body_a) && w.gives_way(c.body_b) ? ContactHardness::Soft : ContactHardness::Stiff;
}

// Whether all that moves is of about one mass.
template <class Real>
bool masses_alike(const WorldData<Real>& w) {
  Real lightest = std::numeric_limits<Real>::max(), heaviest = 0;
  for (const int body : w.awake) {
    if (!w.gives_way(body) || in_hinge_tree(w, body)) continue;
    lightest = std::min(lightest, w.bodies[body].mass), heaviest = std::max(heaviest, w.bodies[body].mass);
  }
  return heaviest <= Real(tuning::kDirectMassRatio) * lightest;
}

template <class Real>
bool is_swept(const WorldData<Real>& w, const JointRecord& joint) {
  const bool a = w.gives_way(joint.body_a), b = w.gives_way(joint.body_b);
  return joint.active && (a || b) && !in_hinge_tree(w, a ? joint.body_a : joint.body_b);
}

// Joints that no mechanism holds.
template <class Real>
int swept_joints(const WorldData<Real>& w) {
  return w.joint_set.active_count() - w.scratch.trees.hinges;
}

// Takes islands with joints whose masses are alike out of the choice: they get a size beyond it.
template <class Real>
void note_mass_ratios(WorldData<Real>& w) {
  w.scratch.lightest.assign(w.bodies.size(), std::numeric_limits<Real>::max());
  w.scratch.heaviest.assign(w.bodies.size(), 0);
  for (const int body : w.awake) {
    const Real mass = w.bodies[body].mass;
    if (!w.gives_way(body)) continue;
    const int root = w.scratch.island_of[body];
    w.scratch.lightest[root] = std::min(w.scratch.lightest[root], mass),
    w.scratch.heaviest[root] = std::max(w.scratch.heaviest[root], mass);
  }
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (!is_swept(w, joint)) return;
    const int root = w.scratch.island_of[w.gives_way(joint.body_a) ? joint.body_a : joint.body_b];
    if (w.scratch.heaviest[root] <= Real(tuning::kDirectMassRatio) * w.scratch.lightest[root]) {
      w.scratch.island_size[root] = tuning::kDirectRows + 1;
    }
  });
}

// In the size of an island of which only the joints are solved directly.
constexpr int kJointsAlone = -1;

// Takes all islands with joints into the choice, the largest with their joints alone.
template <class Real>
void choose_articulated(WorldData<Real>& w) {
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (!is_swept(w, joint)) return;
    int& size =
        w.scratch.island_size[w.scratch.island_of[w.gives_way(joint.body_a) ? joint.body_a : joint.body_b]];
    size = size > tuning::kArticulatedRows ? kJointsAlone : std::min(size, tuning::kDirectRows);
  });
}

// Takes towers and other slender heaps into the choice, however high: contacts that close no loops, with few
// on any body, have a factorisation of linear cost.
template <class Real>
void choose_slender(WorldData<Real>& w) {
  std::vector<int>& room = w.scratch.island_room;
  room.assign(w.bodies.size(), 2 * tuning::kSlenderLoops);
  for (const int body : w.awake) {
    if (!w.gives_way(body)) continue;
    int& left = room[w.scratch.island_of[body]];
    left = w.bodies[body].constraints > tuning::kSlenderContacts ? -tuning::kSlenderRows : left + 2;
  }
  for (const int body : w.awake) {
    int& size = w.scratch.island_size[body];
    if (size > tuning::kDirectRows && size <= tuning::kSlenderRows && size <= room[body])
      size = tuning::kDirectRows;
  }
}

// Islands by the body that stands for them, with the most rows that each may have in `w.scratch.island_size`:
// beyond tuning::kDirectRows they are left to the sweeps.
template <class Real>
void find_islands(WorldData<Real>& w) {
  UnionFind islands(w.scratch.island_of, w.bodies.size());
  const auto tie = [&](int a, int b) {
    if (w.gives_way(a) && w.gives_way(b)) islands.join(a, b);
  };
  w.graph.for_each([&](const ContactConstraint<Real>& c) { tie(c.body_a, c.body_b); });
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (is_swept(w, joint)) tie(joint.body_a, joint.body_b);
  });
  w.scratch.island_size.assign(w.bodies.size(), 0);
  w.scratch.island_place.assign(w.bodies.size(), kNone);
  const auto count = [&](int a, int b, int rows) {
    w.scratch.island_size[islands.find(w.gives_way(a) ? a : b)] += rows;
  };
  w.graph.for_each([&](const ContactConstraint<Real>& c) { count(c.body_a, c.body_b, 2); });
  for (const int body : w.awake) w.scratch.island_of[body] = islands.find(body);
  choose_slender(w);
  if (swept_joints(w) == 0) return;
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (is_swept(w, joint)) count(joint.body_a, joint.body_b, 2);
  });
  if (w.settings.solver == Solver::Direct) {
    choose_articulated(w);
  } else {
    note_mass_ratios(w);
  }
}

template <class Real>
DirectIsland<Real>& island_at(WorldData<Real>& w, int root) {
  int& place = w.scratch.island_place[root];
  if (place == kNone) {
    place = w.scratch.direct_count++;
    if (w.scratch.direct_count > static_cast<int>(w.scratch.direct.size()))
      w.scratch.direct.emplace_back(&w.scratch.room);
    w.scratch.direct[place].contacts.clear(), w.scratch.direct[place].joints.clear();
    w.scratch.direct[place].root = root;
  }
  return w.scratch.direct[place];
}

template <class Real>
void put_row(const RigidRow<Real>& from, DirectRow<Real>& row) {
  row.linear_a = from.row.linear_a, row.linear_b = from.row.linear_b;
  row.angular_a = from.row.angular_a, row.angular_b = from.row.angular_b;
  row.gap = from.gap;
  row.impulse = from.impulse;
  row.turning_a = from.turning_a, row.turning_b = from.turning_b, row.sliding = from.sliding;
}

template <class Real>
void add_rows(WorldData<Real>& w, DirectIsland<Real>& island) {
  std::pmr::vector<DirectRow<Real>>& rows = island.system.rows;
  rows.clear();
  find_links(w, island);
  int block = 0;
  for (const int joint : island.joints) {
    RigidRow<Real> rigid[kMostRigidRows];
    const int count = w.joint_set.rigid_rows(joint, rigid);
    const auto [a, b] = w.joint_set.bodies(joint);
    for (int i = 0; i < count; ++i) {
      DirectRow<Real> row;
      row.a = a, row.b = b;
      put_row(rigid[i], row);
      row.block = block;
      rows.push_back(row);
    }
    if (count > 0) ++block;
  }
  island.joint_rows = static_cast<int>(rows.size());
  // Contacts of what is jointed stay with the sweeps, as friction and the joints' limits do, which press
  // against them: between two solvers impulses that cancel would grow without end.
  if (island.joint_rows > 0) island.contacts.clear();
  for (ContactConstraint<Real>* c : island.contacts) {
    const int before = static_cast<int>(rows.size());
    for (int i = 0; i < c->count; ++i) {
      // What neither presses nor overlaps is left to the sweeps.
      if (c->normal_impulse[i] == 0 && c->separation[i] > 0) continue;
      DirectRow<Real> row;
      row.a = c->body_a, row.b = c->body_b;
      row.linear_a = -c->normal, row.linear_b = c->normal;
      row.angular_a = -c->arm_a[i], row.angular_b = c->arm_b[i];
      row.impulse = &c->normal_impulse[i];
      row.one_sided = true;
      row.block = block;
      rows.push_back(row);
    }
    if (static_cast<int>(rows.size()) > before) ++block;
  }
}

// The contacts and joints of islands that are small enough.
template <class Real>
void fill_islands(WorldData<Real>& w) {
  const auto root_of = [&](int a, int b) { return w.scratch.island_of[w.gives_way(a) ? a : b]; };
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    const int root = root_of(c.body_a, c.body_b), rows = w.scratch.island_size[root];
    if (rows > 2 && rows <= tuning::kDirectRows) island_at(w, root).contacts.push_back(&c);
  });
  if (swept_joints(w) == 0) return;
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (!is_swept(w, joint)) return;
    const int root = root_of(joint.body_a, joint.body_b);
    if (w.scratch.island_size[root] <= tuning::kDirectRows) island_at(w, root).joints.push_back(joint.slot);
  });
}

// False when the island would cost too much to solve directly.
template <class Real>
bool make_system(WorldData<Real>& w, DirectIsland<Real>& island) {
  add_rows(w, island);
  const bool articulated = w.settings.solver == Solver::Direct && !island.joints.empty();
  const double most = articulated ? tuning::kArticulatedCost : tuning::kDirectCost;
  if (island.system.order(w.motion.data()) <= most) return true;
  if (!articulated || island.contacts.empty()) return false;
  island.contacts.clear();
  add_rows(w, island);
  return island.system.order(w.motion.data()) <= most;
}

// Leaves an island to the sweeps, for the rest of the step.
template <class Real>
void give_up(WorldData<Real>& w, DirectIsland<Real>& island) {
  for (ContactConstraint<Real>* c : island.contacts) c->hardness = hardness_of(w, *c);
  restore_links(w, island);
  island.contacts.clear(), island.joints.clear(), island.system.rows.clear();
  island.joint_rows = 0;
}

// Joints turn with their bodies: their rows are those of the last evaluation.
template <class Real>
void refresh_joints(WorldData<Real>& w, DirectIsland<Real>& island) {
  std::size_t next = 0;
  for (const int joint : island.joints) {
    RigidRow<Real> rigid[kMostRigidRows];
    const int count = w.joint_set.rigid_rows(joint, rigid);
    for (int i = 0; i < count; ++i) {
      DirectRow<Real>& row = island.system.rows[next++];
      put_row(rigid[i], row);
      row.bias = 0;
    }
  }
}

// Whether a joint is open so wide that a Newton step may not close it.
template <class Real>
bool wide_open(const DirectIsland<Real>& island) {
  for (int i = 0; i < island.joint_rows; ++i) {
    const DirectRow<Real>& row = island.system.rows[i];
    const Real arms = std::abs(row.angular_a) + std::abs(row.angular_b);
    if (std::abs(row.gap) > Real(tuning::kWideGap) * arms) return true;
  }
  return false;
}

template <class Real>
Real separation_now(const BodyMotion<Real>* motion, const DirectRow<Real>& row, Real at_start) {
  const BodyMotion<Real>&a = motion[row.a], &b = motion[row.b];
  return at_start + dot(row.linear_b, b.moved - a.moved) + row.angular_a * a.turned +
         row.angular_b * b.turned;
}

}  // namespace

template <class Real>
void prepare_direct_islands(WorldData<Real>& w, const JointStep<Real>& joints) {
  w.scratch.direct_count = 0;
  const bool articulated = w.settings.solver == Solver::Direct;
  if (!articulated && !w.settings.direct_islands) return;
  if (w.graph.empty() && (swept_joints(w) == 0 || (!articulated && masses_alike(w)))) return;
  if (!w.scratch.islands_known) find_islands(w);
  w.scratch.islands_known = true;
  fill_islands(w);
  for (int i = 0; i < w.scratch.direct_count; ++i) {
    DirectIsland<Real>& island = w.scratch.direct[i];
    if (!make_system(w, island)) {
      give_up(w, island);
      continue;
    }
    load_links(w, island, joints.h);
    for (ContactConstraint<Real>* c : island.contacts) c->hardness = ContactHardness::Rigid;
    island.system.factorise(w.motion.data());
  }
}

template <class Real>
void solve_direct_islands(WorldData<Real>& w, const ContactStep<Real>& step, const JointStep<Real>& joints,
                          bool push) {
  for (int i = 0; i < w.scratch.direct_count; ++i) {
    DirectIsland<Real>& island = w.scratch.direct[i];
    if (island.system.rows.empty()) continue;  // left to the sweeps
    refresh_joints(w, island);
    std::size_t next = static_cast<std::size_t>(island.joint_rows);
    double push_speed = island.contacts.empty() ? std::numeric_limits<double>::infinity() : 0;
    for (ContactConstraint<Real>* c : island.contacts) {
      push_speed = std::max(push_speed, static_cast<double>(c->push_speed));
      for (int k = 0; k < c->count; ++k) {
        if (next >= island.system.rows.size() || island.system.rows[next].impulse != &c->normal_impulse[k])
          continue;
        DirectRow<Real>& row = island.system.rows[next++];
        const Real s = separation_now(w.motion.data(), row, c->separation[k]);
        const Real rate = step.softness[static_cast<int>(ContactHardness::Rigid)][0].bias_rate;
        row.bias = s > 0 ? s * step.inverse_h : push ? std::max(rate * s, -c->push_speed) : Real(0);
      }
    }
    if (push && island.joint_rows > 0) pull_gaps(w, island, joints);
    if (!push && !island.joints.empty()) {
      load_links(w, island, joints.h);
      damp_links(w, island);
      island.system.factorise(w.motion.data());
      close_gaps(w, island, joints.h);
    }
    const bool found = island.system.find(w.motion.data(), push_speed);
    if (found) island.system.apply(w.motion.data());
    if (!found && island.system.contradicted()) give_up(w, island);
  }
}

template <class Real>
void close_direct_joints(WorldData<Real>& w, const JointStep<Real>& joints) {
  if (w.settings.solver != Solver::Direct || w.scratch.direct_count == 0) return;
  bool open = true;
  for (int pass = 0; open && pass < tuning::kClosings; ++pass) {
    open = false;
    w.joint_set.evaluate(w.solver_bodies(), joints);
    for (int i = 0; i < w.scratch.direct_count; ++i) {
      DirectIsland<Real>& island = w.scratch.direct[i];
      if (island.joint_rows == 0 || island.system.rows.empty()) continue;
      // Points that press stay as they are: their gap is 0.
      refresh_joints(w, island);
      open = wide_open(island) || open;
      island.system.factorise(w.motion.data());
      island.system.correct();
      island.system.move(w.motion.data(), w.rotation.data());
    }
    hold_locks(w);  // the rows know masses alone
  }
}

template <class Real>
void finish_direct_islands(WorldData<Real>& w) {
  for (int i = 0; i < w.scratch.direct_count; ++i) {
    for (ContactConstraint<Real>* c : w.scratch.direct[i].contacts) c->hardness = hardness_of(w, *c);
    restore_links(w, w.scratch.direct[i]);
    w.scratch.island_place[w.scratch.direct[i].root] = kNone;
  }
}

#define PLUMB_FOR(Real)                                                                                  \
  template void prepare_direct_islands(WorldData<Real>&, const JointStep<Real>&);                        \
  template void solve_direct_islands(WorldData<Real>&, const ContactStep<Real>&, const JointStep<Real>&, \
                                     bool);                                                              \
  template void close_direct_joints(WorldData<Real>&, const JointStep<Real>&);                           \
  template void finish_direct_islands(WorldData<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
