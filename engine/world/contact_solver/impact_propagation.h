#pragma once

#include <memory_resource>
#include <utility>
#include <vector>

#include "engine/linear_algebra/bounded_rows.h"
#include "engine/world/contact_solver/restitution_contacts.h"

namespace plumb {

/// A point with an impact, in one round.
template <class Real>
struct StruckPoint {
  RestitutionContact<Real>* bounce = nullptr;
  int point = 0;
  Real time = 0;     ///< s, since the start of the substep
  Real wanted = 0;   ///< m/s, target velocity along the normal
  Real before = 0;   ///< m/s, velocity along the normal before the round
  Real impulse = 0;  ///< N s
  int group = 0;     ///< the same for points that share a body, directly or through others
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

  // By group; valid for those of the present crowd.
  std::vector<char> reached;       ///< impacts may propagate to it
  std::vector<char> struck_now;    ///< it has an impact in this round
  std::vector<char> marked;        ///< it is in `groups`
  std::vector<Real> earliest;      ///< s, time of its next impact
  std::vector<Real> last;          ///< s, time of its last impact
  std::vector<int> first_contact;  ///< first of the crowd's contacts at it: edge = 2 contact + side
  std::vector<int> struck_at;      ///< struck point of the present round at it
  // By contact.
  std::vector<int> next;      ///< by edge: the next one at the same group
  std::vector<char> in_list;  ///< it is in a list of the present round
  std::vector<ComingImpact<Real>> coming;
  // Lists.
  std::vector<int> crowd;   ///< contacts to which impacts may propagate, ascending
  std::vector<int> looked;  ///< contacts to look at
  std::vector<int> groups;  ///< those whose impacts have changed
  std::vector<StruckPoint<Real>> struck, grouped;
  std::vector<int> following, latest;  ///< by struck point: the next one of its group; the last one so far

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

/// Finds the contacts that impacts may reach, before `propagate_impacts`. Returns false if there are none. So
/// far joints are given by `room.group` alone; the caller then fills in the rows of joints whose group is
/// reached.
template <class Real>
bool find_reached_contacts(const BodyMotion<Real>* motion, std::vector<RestitutionContact<Real>>& bounces,
                           const ContactStep<Real>& step, ImpactScratch<Real>& room);

/// Resolves the impacts of a substep by impact propagation. A body with an impact passes it on to others that
/// it touches or is about to touch (the break of a rack). Runs before the constraints are solved, in rounds.
/// Each resolves the earliest impacts; simultaneous ones are resolved together by Newton's law, (n.v)' = -e
/// n.v. With lambda >= 0 the impulses of a round change its energy by the sum of lambda (n.v + (n.v)') / 2.
/// Impulses of iterations that have not converged are scaled back until this is not positive, so no round
/// gains energy. Friction follows, at most as much as stops the sliding. Impacts of a round that share no
/// dynamic body, directly or by joints, are solved apart. A round examines only contacts of bodies that the
/// last one has struck: the cost depends on the number of impacts, not on the size of the crowd.
/// Joints pass impacts on at once: in each round the rows of a group's joints have impulses such that none of
/// their rates changes, J M^-1 (J^T mu + N^T lambda) = 0. The impulses mu do no work.
///
/// An impulse at the time t displaces a body by (h - t) times the change in velocity. The excess of the
/// substep's motion is subtracted from the position.
///
/// Returns the number of rounds. If no time passes for many rounds, it stops and leaves the rest to the
/// constraints. Between two walls that both push, a body would bounce for ever.
template <class Real>
int propagate_impacts(BodyMotion<Real>* motion, Rotation<Real>* rotation,
                      std::vector<RestitutionContact<Real>>& bounces, const ContactStep<Real>& step,
                      ImpactScratch<Real>& room);

}  // namespace plumb
