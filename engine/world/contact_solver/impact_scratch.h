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
struct ImpactPoint {
  RestitutionContact<Real>* bounce = nullptr;
  int point = 0;
  Real time = 0;             ///< s, since the start of the substep
  Real target = 0;           ///< m/s, target velocity along the normal
  Real velocity_before = 0;  ///< m/s, velocity along the normal before the round
  Real impulse = 0;          ///< N s
  Real friction = 0;         ///< N s, along the tangent
  Real slip_before = 0;      ///< m/s, along the tangent before the round, relative to the surface speed
  int group = 0;             ///< the same for points that share a body, directly or through others
};

/// Next impacts of a contact's points, from the current motion of its bodies.
template <class Real>
struct PredictedImpact {
  Real time[2] = {};             ///< s, since the start of the substep; infinity: none
  Real target[2] = {};           ///< m/s, target velocity along the normal
  Real velocity_before[2] = {};  ///< m/s, velocity along the normal
};

/// A joint that propagates impacts at once.
struct ImpactJoint {
  int a = 0, b = 0;             ///< bodies
  int slot = 0;                 ///< in the joint set
  int first_row = 0, rows = 0;  ///< in `ImpactScratch::rows`
  bool rows_ready = false;      ///< its rows are those of the present substep
  int next = -1;                ///< joint of the same group, in `ImpactScratch::joints`
  Vec2d arm{};                  ///< m, of b's anchor in the present substep
  Vec2d impulse{};              ///< N s, on b, in the impacts of the step
  double moment = 0;            ///< N m s, of it about b's anchor
};

/// Scratch memory of `propagate_impacts`, kept to avoid allocations. A group is a set of bodies connected by
/// joints, identified by its lowest body index; a body without joints is a group of its own.
template <class Real>
struct ImpactScratch {
  explicit ImpactScratch(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : system(memory) {}

  // Joints, filled in by the caller; all lists are empty if there are none.
  std::vector<int> group;  ///< by body
  std::vector<ImpactJoint> joints;
  std::vector<int> first_joint;  ///< by group, in `joints`
  std::vector<BoundedRow> rows;  ///< between bodies of the world: equalities, or an impulse of at least 0

  // The impacts of the substep.
  std::vector<int> impacts;  ///< contacts that have impacts, ascending
  int point_count = 0;       ///< their points that have impacts
  Real max_approach = 0;     ///< m/s, the fastest approach of these
  Real max_restitution = 0;  ///< the largest coefficient of these contacts

  /// Appends the rows of a joint that takes part in an impact.
  void (*append_rows)(void* world, ImpactJoint& joint) = nullptr;
  void* world = nullptr;  ///< for `append_rows`

  // By group.
  bool linked = false;             ///< the contacts of groups are those of the present step
  std::vector<char> visited;       ///< its joints have been added in this round
  std::vector<char> in_groups;     ///< it is in `groups`
  std::vector<Real> earliest;      ///< s, time of its next impact
  std::vector<Real> last;          ///< s, time of its last impact
  std::vector<int> first_contact;  ///< first of the contacts at it: edge = 2 contact + side
  std::vector<int> point_at;       ///< impact point of the current round at it
  // By contact.
  std::vector<int> next;          ///< by edge: the next one at the same group
  std::vector<char> in_pending;   ///< it is in `pending`
  std::vector<char> is_examined;  ///< it is in `examined`
  std::vector<PredictedImpact<Real>> predicted;
  // Lists.
  std::vector<int> pending;   ///< contacts to examine
  std::vector<int> examined;  ///< contacts examined in any round
  std::vector<int> groups;    ///< those whose impacts have changed
  std::vector<ImpactPoint<Real>> points, sorted_points;
  std::vector<int> next_in_group;  ///< by impact point
  std::vector<int> last_in_group;  ///< by impact point, the last one so far

  bool has_other_contacts = false;  ///< without restitution, which impacts leave to the solver
  // Bodies that the impacts of the substep have displaced, and by how much.
  std::vector<int> displaced;
  std::vector<Vec2<Real>> displacement;  ///< m, by body, of those in contacts that may bounce
  std::vector<Real> delta_angle;         ///< rad

  // The joints and bodies of the impact points in a round, and their rows.
  struct Link {
    int body = 0;
    Vec2<Real> velocity{};  ///< m/s, before the round
    Real spin = 0;          ///< rad/s
  };
  std::vector<int> active_joints;  ///< in `joints`
  std::vector<Link> links;
  std::vector<int> link_index;  ///< by body
  std::vector<std::pair<int, int>> blocks;
  std::vector<int> sizes;
  BoundedRows system;
};

/// Moves and rotates a body, and adds the displacement to its sum.
template <class Real>
void displace(ImpactScratch<Real>& scratch, SolverBody<Real>& moving, Rotation<Real>& rotation, int body,
              Vec2<Real> displacement, Real delta_angle) {
  if (!is_dynamic(moving)) return;
  if (scratch.displacement[body] == Vec2<Real>{} && scratch.delta_angle[body] == 0)
    append(scratch.displaced, body);
  scratch.displacement[body] += displacement, scratch.delta_angle[body] += delta_angle;
  moving.delta_position += displacement;
  if (delta_angle != 0) moving.delta_angle += delta_angle, rotation = rotated_by(rotation, delta_angle);
}

/// Returns the group of a body.
template <class Real>
int group_of(const ImpactScratch<Real>& scratch, int body) {
  return scratch.group.empty() ? body : scratch.group[body];
}

}  // namespace plumb
