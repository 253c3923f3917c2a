#pragma once

#include <vector>

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

/// The points of a contact with an impact to come, as its bodies move now; infinity: none.
template <class Real>
struct ComingImpact {
  Real time[2] = {};    ///< s, since the start of the substep
  Real wanted[2] = {};  ///< m/s, target velocity along the normal
  Real before[2] = {};  ///< m/s, velocity along the normal
};

/// Scratch memory of `propagate_impacts`, kept to avoid allocations. Lists by body are valid for the bodies
/// of the present crowd only.
template <class Real>
struct ImpactScratch {
  // By body.
  std::vector<char> reached;       ///< impacts may propagate to the body
  std::vector<char> marked;        ///< it is in a list of the present round
  std::vector<Real> earliest;      ///< s, time of its next impact
  std::vector<Real> last;          ///< s, time of its last impact
  std::vector<int> first_contact;  ///< first of the crowd's contacts at it: edge = 2 contact + side
  std::vector<int> group;          ///< struck point of the present round at it
  // By contact.
  std::vector<int> next;      ///< by edge: the next one at the same body
  std::vector<char> in_list;  ///< it is in a list of the present round
  std::vector<ComingImpact<Real>> coming;
  // Lists.
  std::vector<int> crowd;   ///< contacts to which impacts may propagate, ascending
  std::vector<int> looked;  ///< contacts to look at
  std::vector<int> bodies;  ///< bodies whose impacts have changed
  std::vector<StruckPoint<Real>> struck;
};

/// Resolves the impacts of a substep by impact propagation. A body with an impact passes it on to others that
/// it touches or is about to touch (the break of a rack). Runs before the constraints are solved, in rounds.
/// Each resolves the earliest impacts; simultaneous ones are resolved together by Newton's law, (n.v)' = -e
/// n.v. With lambda >= 0 the impulses of a round change its energy by the sum of lambda (n.v + (n.v)') / 2.
/// Impulses of iterations that have not converged are scaled back until this is not positive, so no round
/// gains energy. Friction follows, at most as much as stops the sliding. Impacts of a round that share no
/// body are solved apart. A round looks at the contacts of bodies that the last one has struck, and at no
/// others: the cost is that of the impacts, not of the crowd.
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
