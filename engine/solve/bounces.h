#pragma once

#include <vector>

#include "engine/solve/soft_contacts.h"

namespace plumb {

/// A contact whose restitution is not 0, and when and how it bounces in the substep.
template <class Real>
struct Bounce {
  ContactConstraint<Real>* contact = nullptr;
  Real before[2] = {};  ///< m/s, velocity along the normal at the substep's start
  Real way[2] = {};     ///< m, what its points are to be open at the substep's end
  Real speed[2] = {};   ///< m/s, and how fast they are to part then
  bool strikes[2] = {};
  bool closes = false;  ///< fast enough to bounce
};

/// Lists the contacts that may bounce.
template <class Real>
void find_bounces(ContactGraph<Real>& graph, std::vector<Bounce<Real>>& bounces);

/// Notes how fast points approach before anything acts. What parts after a bounce is not to be warm started.
template <class Real>
void note_approaches(const BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces,
                     const ContactStep<Real>& step);

/// Gives each bounce its place in the substep, once it is known what accelerates the bodies; false when
/// nothing bounces.
///
/// A point that is s open and closes at u with the acceleration a strikes with c = sqrt(u^2 + 2 a s) after
/// t = 2 s / (u + c). From there on it flies: at the substep's end it is e c (h - t) - a (h - t)^2 / 2 open
/// and parts at e c - a (h - t). With e = 1 that keeps the energy c^2 / 2, whatever h is.
template <class Real>
bool place_bounces(const BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces,
                   const ContactStep<Real>& step);

/// After solve_contacts: the velocities that carry the bodies to where they are at the substep's end.
template <class Real>
void bounce_positions(BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces,
                      const ContactStep<Real>& step);

/// After relax_contacts: the velocities that they have there. What will strike in the next substep is let
/// through to it with the speed it has.
template <class Real>
void bounce_velocities(BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces);

}  // namespace plumb
