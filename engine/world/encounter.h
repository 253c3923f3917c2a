#pragma once

#include <cstdint>

#include "engine/collide/contact_manifold.h"
#include "engine/world/world_data.h"

namespace plumb {

/// What becomes of two shapes that are apart if their bodies move on through the step as they do now.
enum class Outlook : std::uint8_t {
  Unsearched,  ///< no plane between them would be crossed, or they touch already
  Misses,      ///< a plane would be crossed, and the shapes pass each other all the same
  Meets,       ///< they touch
};

/// Where two shapes are going to touch within the step, when the outlook is that they meet.
template <class Real>
struct Encounter {
  Outlook outlook = Outlook::Unsearched;
  ContactManifold<Real> manifold{};  ///< there, in the frame of a
  Rotation<Real> rotation{};         ///< of a there
  Vec2<Real> between{};              ///< m, from a's centre of mass to b's there
  Vec2<Real> closed{};               ///< m, by how much that has changed since the step's start
  Real turned_a = 0, turned_b = 0;   ///< rad, until then
  Vec2<Real> velocity{};             ///< m/s, of b's centre of mass as a's sees it, there
};

/// Looks where two shapes, whose points now are `closest`, are going to touch. A plane through the closest
/// points is a guess: what passes a corner closely would be deflected by it, and what turns on its way
/// strikes elsewhere. So a plane that is going to be crossed is one where the shapes meet, or none.
///
/// Shapes without points are searched when they come nearer to each other in a step than a plane can be
/// guessed from, by more than the smaller one's extent (half of it, when they bounce), and neither body is
/// fast for its own size: small ones would be deep in the other before they had a contact. Fast ones are
/// stopped on their way (continuous.cpp).
///
/// Solvers look a substep ahead: planes count that would be crossed within one of these after the step.
///
/// Bodies in free flight move on their parabola, all others straight on.
template <class Real>
Encounter<Real> find_encounter(const WorldData<Real>& w, const ContactRecord& contact,
                               const ContactManifold<Real>& closest, Real dt, Real substep);

}  // namespace plumb
