#pragma once

#include <vector>

#include "engine/solve/bounces.h"

namespace plumb {

/// Where a point is struck, in a round of impacts.
template <class Real>
struct StruckPoint {
  Bounce<Real>* bounce = nullptr;
  int point = 0;
  Real time = 0;     ///< s, within the substep
  Real wanted = 0;   ///< m/s, along the normal, afterwards
  Real before = 0;   ///< m/s, likewise, before the round
  Real impulse = 0;  ///< N s
};

/// What `resolve_crowds` works in: kept for its room alone. By body, but for the two lists.
template <class Real>
struct CrowdRoom {
  std::vector<char> reached;   ///< whether impacts may be handed on to it
  std::vector<Real> earliest;  ///< s, its next impact
  std::vector<Real> last;      ///< s, its last one
  std::vector<Bounce<Real>*> crowd;
  std::vector<StruckPoint<Real>> struck;
};

/// Resolves the impacts of a substep, of bodies that others hold: one that is struck while it touches others,
/// or is about to, strikes them in turn (the break of a rack, a ball into a pile). Before the constraints are
/// solved, round after round: of all that approach each other, those go first that come first, and those that
/// come at once are resolved at once by Newton's law, (n.v)' = -e n.v. With lambda >= 0 the impulses of a
/// round, its energy changes by the sum of lambda (n.v + (n.v)') / 2; sweeps that have not converged are
/// scaled back until that is not positive: no round gains energy. Friction follows, as far as it stops what
/// slides.
///
/// An impulse at the time t moves a body by (h - t) of the change in velocity: bodies are moved back by what
/// the substep's motion has too much.
///
/// Returns the rounds that it took. They end, and the rest is left to the constraints, when no time passes
/// for many of them: between two walls that both push, a body would bounce for ever.
template <class Real>
int resolve_crowds(BodyMotion<Real>* motion, Rotation<Real>* rotation, std::vector<Bounce<Real>>& bounces,
                   const ContactStep<Real>& step, CrowdRoom<Real>& room);

}  // namespace plumb
