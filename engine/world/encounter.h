#pragma once

#include "engine/collide/contact_manifold.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Where two shapes are going to touch within the step.
template <class Real>
struct Encounter {
  ContactManifold<Real> manifold;  ///< there, in the frame of a; without points when they do not meet
  Rotation<Real> rotation;         ///< of a there
  Vec2<Real> between{};            ///< m, from a's centre of mass to b's there
  Real time = 0;                   ///< s, from the step's start
};

/// For shapes that come nearer to each other in a step than a plane of contact can be guessed from: by more
/// than the smaller one's extent. Neither body is fast for its own size, so that no way of it is
/// followed (continuous.cpp), but small ones would be deep in the other before they had a contact. They move
/// on with the velocities that they have.
template <class Real>
Encounter<Real> find_encounter(const WorldData<Real>& w, const ContactRecord& contact, Real dt);

}  // namespace plumb
