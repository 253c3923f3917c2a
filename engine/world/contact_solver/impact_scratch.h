#pragma once

#include <memory_resource>
#include <utility>
#include <vector>

#include "engine/core/capacity.h"
#include "engine/linear_algebra/bounded_rows.h"
#include "engine/math/small_rotation.h"
#include "engine/world/contact_solver/restitution_contacts.h"

namespace plumb {

/// A point with an impact, in one round.
template <class Real>
struct StruckPoint {
  RestitutionContact<Real>* bounce = nullptr;
  int point = 0;
  Real time = 0;      ///< s, since the start of the substep
  Real wanted = 0;    ///< m/s, target velocity along the normal
  Real before = 0;    ///< m/s, velocity along the normal before the round
  Real impulse = 0;   ///< N s
  Real friction = 0;  ///< N s, along the tangent
  Real sliding = 0;   ///< m/s, along the tangent before the round, relative to the surface speed
  int group = 0;      ///< the same for points that share a body, directly or through others
};

/// Impact times of a contact's points, for the present motion of its bodies; infinity: none.
template <class Real>
struct ComingImpact {
  Real time[2] = {};    ///< s, since the start of the substep
  Real wanted[2] = {};  ///< m/s, target velocity along the normal
  Real before[2] = {};  ///< m/s, velocity along the normal
};

/// A joint that passes impacts on at once.
struct ImpactJoint {
  int a = 0, b = 0;             ///< bodies
  int slot = 0;                 ///< in the joint set
  int first_row = 0, rows = 0;  ///< in `ImpactScratch::rows`
  bool known = false;           ///< its rows are those of the present substep
  int next = -1;                ///< joint of the same group, in `ImpactScratch::joints`
};

/// Scratch memory of `propagate_impacts`, kept to avoid allocations. A group is a set of bodies connected by
/// joints, identified by its lowest body index; a body without joints is a group of its own.
template <class Real>
struct ImpactScratch {
  explicit ImpactScratch(std::pmr::memory_resource* room = std::pmr::get_default_resource()) : system(room) {}

  // Joints, filled by the caller; all empty where there are none.
  std::vector<int> group;  ///< by body
  std::vector<ImpactJoint> joints;
  std::vector<int> first_joint;  ///< by group, in `joints`
  std::vector<BoundedRow> rows;  ///< between bodies of the world: equalities, or an impulse of at least 0

  // The impacts of the substep.
  std::vector<int> strikes;   ///< contacts that have impacts, ascending
  int struck_points = 0;      ///< their points that have
  Real fastest = 0;           ///< m/s, the fastest approach of these
  Real most_restitution = 0;  ///< the largest coefficient of these contacts

  void (*fill_rows)(void* world, ImpactJoint& joint) = nullptr;  ///< appends those of a joint that is struck
  void* world = nullptr;                                         ///< for `fill_rows`

  // By group.
  bool linked = false;             ///< the contacts of groups are those of the present step
  std::vector<char> struck_now;    ///< it has an impact in this round
  std::vector<char> marked;        ///< it is in `groups`
  std::vector<Real> earliest;      ///< s, time of its next impact
  std::vector<Real> last;          ///< s, time of its last impact
  std::vector<int> first_contact;  ///< first of the contacts at it: edge = 2 contact + side
  std::vector<int> struck_at;      ///< struck point of the present round at it
  // By contact.
  std::vector<int> next;      ///< by edge: the next one at the same group
  std::vector<char> in_list;  ///< it is in a list of the present round
  std::vector<char> seen;     ///< it is in `all_seen`
  std::vector<ComingImpact<Real>> coming;
  // Lists.
  std::vector<int> looked;    ///< contacts to look at
  std::vector<int> all_seen;  ///< contacts examined in any round
  std::vector<int> groups;    ///< those whose impacts have changed
  std::vector<StruckPoint<Real>> struck, grouped;
  std::vector<int> following, latest;  ///< by struck point: the next one of its group; the last one so far

  // Bodies that the impacts of the substep have displaced, and by how much.
  bool unplaced = false;  ///< there are contacts without restitution, which impacts leave to the solver
  std::vector<int> displaced;
  std::vector<Vec2<Real>> way;  ///< m, by body, of those in contacts that may bounce
  std::vector<Real> turn;       ///< rad

  // The joints and bodies of struck points in a round, and their rows.
  struct Link {
    int body = 0;
    Vec2<Real> velocity{};  ///< m/s, before the round
    Real spin = 0;          ///< rad/s
  };
  std::vector<int> taking_part;  ///< in `joints`
  std::vector<Link> links;
  std::vector<int> link_of;  ///< by body
  std::vector<std::pair<int, int>> blocks;
  std::vector<int> sizes;
  BoundedRows system;
};

/// Moves and rotates a body, and adds the displacement to its sum.
template <class Real>
void displace(ImpactScratch<Real>& room, SolverBody<Real>& moving, Rotation<Real>& rotation, int body,
              Vec2<Real> way, Real turn) {
  if (!is_dynamic(moving)) return;
  if (room.way[body] == Vec2<Real>{} && room.turn[body] == 0) append(room.displaced, body);
  room.way[body] += way, room.turn[body] += turn;
  moving.delta_position += way;
  if (turn != 0) moving.delta_angle += turn, rotation = rotated_by(rotation, turn);
}

/// Returns the group of a body.
template <class Real>
int group_of(const ImpactScratch<Real>& room, int body) {
  return room.group.empty() ? body : room.group[body];
}

}  // namespace plumb
