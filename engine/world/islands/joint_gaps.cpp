#include "engine/world/islands/joint_gaps.h"

#include <algorithm>

#include "engine/world/islands/island_links.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

// Most loops of a mechanism that is closed: 8 x 8 bodies tied to their neighbours have 49. The cost grows
// with the square of their number; a net of 30 x 30 is open in each step, and would cost as much again as its
// step.
constexpr int kLoops = 64;

// Marks of a joint, by slot.
enum : char { kClosed, kOpen, kCollected };

// Adds a joint's rows: rigid ones and exceeded limits, to be closed, and motors, not to be turned.
template <class Real>
void add_rows(WorldData<Real>& w, JointedIsland<Real>& island, int block) {
  std::vector<JointSolverRow<Real>>& rows = w.scratch.joint_rows;
  rows.clear();
  w.joint_set.solver_rows(island.joints[block], w.solver_bodies(), rows);
  const auto [link_a, link_b] = island.blocks[block];
  for (const JointSolverRow<Real>& from : rows) {
    const bool open_limit = from.role == RowRole::Limit && !(from.row.residual < 0);
    if (open_limit || from.role == RowRole::Spring) continue;
    BoundedRow row{.a = link_a, .b = link_b};
    row.linear_a = from.row.linear_a.template as<double>();
    row.linear_b = from.row.linear_b.template as<double>();
    row.angular_a = from.row.angular_a, row.angular_b = from.row.angular_b;
    row.gap = from.role == RowRole::Motor ? 0 : double(from.row.residual);
    row.block = block;
    island.system.rows.push_back(row);
  }
}

template <class Real>
void make_rows(WorldData<Real>& w, JointedIsland<Real>& island) {
  island.system.rows.clear();
  for (int block = 0; block < static_cast<int>(island.joints.size()); ++block) add_rows(w, island, block);
}

// Finds the elimination order; returns the cost of eliminating in it.
template <class Real>
double order(JointedIsland<Real>& island) {
  island.sizes.assign(island.joints.size(), 0);
  for (const BoundedRow& row : island.system.rows) ++island.sizes[row.block];
  return island.system.order(island.blocks, island.sizes);
}

// Returns true if the island of a joint is known to have too many loops.
template <class Real>
bool is_net(const WorldData<Real>& w, int joint) {
  if (!w.scratch.islands_known) return false;
  const auto [a, b] = w.joint_set.bodies(joint);
  return w.scratch.island_joints[w.scratch.island_of[w.is_dynamic(a) ? a : b]] > kLoops;
}

// Collects the mechanism of a joint: all joints that dynamic bodies tie to it. Returns false if it has too
// many loops.
template <class Real>
bool collect(WorldData<Real>& w, JointedIsland<Real>& island, int joint) {
  std::vector<char>& marks = w.scratch.open_joints;
  island.joints.clear();
  start_links(w, island);
  const auto add = [&](int slot) {
    if (marks[slot] == kCollected) return;
    marks[slot] = kCollected;
    island.joints.push_back(slot);
  };
  add(joint);
  for (std::size_t next = 0; next < island.joints.size(); ++next) {
    const auto [a, b] = w.joint_set.bodies(island.joints[next]);
    const std::size_t known = island.links.size();
    const int link_a = link_at(w, island, a);
    island.blocks.emplace_back(link_a, link_at(w, island, b));
    for (std::size_t link = known; link < island.links.size(); ++link) {
      const int body = island.links[link].body;
      if (!w.is_dynamic(body)) continue;
      for_each_edge(w.joints, w.bodies[body].first_joint, [&](int, const JointRecord& record) {
        if (record.active) add(record.slot);
      });
    }
  }
  return static_cast<int>(island.joints.size() - island.links.size()) <= kLoops;
}

template <class Real>
void close(WorldData<Real>& w, JointedIsland<Real>& island) {
  const auto is_open = [&](int joint) {
    return w.joint_set.is_open(joint, w.solver_bodies(), Real(tuning::kOpening));
  };
  for (int round = 0; round < tuning::kCloseRounds; ++round) {
    make_rows(w, island);
    if (round == 0 && order(island) > tuning::kJointedCost) return;
    island.system.correct(tuning::kCloseSoftness);
    shift_links(w, island, tuning::kLinkTurn);
    if (std::none_of(island.joints.begin(), island.joints.end(), is_open)) return;
  }
}

}  // namespace

template <class Real>
void close_joint_gaps(WorldData<Real>& w) {
  std::vector<char>& marks = w.scratch.open_joints;
  marks.assign(static_cast<std::size_t>(w.joint_set.slots()), kClosed);
  if (!w.joint_set.find_open(w.solver_bodies(), Real(tuning::kOpening), marks, &w.crew)) return;
  for (int joint = 0; joint < static_cast<int>(marks.size()); ++joint) {
    if (marks[joint] != kOpen || is_net(w, joint)) continue;
    if (collect(w, w.scratch.opened, joint)) close(w, w.scratch.opened);
  }
}

template void close_joint_gaps(WorldData<float>&);
template void close_joint_gaps(WorldData<double>&);

}  // namespace plumb
