#pragma once

#include <span>

#include "engine/world/new_shape.h"
#include "engine/world/world_data.h"

/// Masses, centres of mass and sizes of bodies, as they follow from their shapes.
///
/// The frame of a dynamic body is at its centre of mass. That of a kinematic one is at its origin, about
/// which it turns; that of a static one stays where the shapes that it was made with had their centre: nobody
/// asks what it weighs. So shapes that come to a static body and go cost the same, however many there are.
/// What changes the mass of another one is noted, and seen to at once for all of them before it matters:
/// before a step, and before any call that acts on motions.
namespace plumb {

/// Finds the mass, the centre and the sizes of a body anew, and moves its frame there.
template <class Real>
void update_mass(WorldData<Real>& w, int body);
/// The same for a body whose type has changed.
template <class Real>
void find_mass(WorldData<Real>& w, int body);
/// From now on the body has this mass, whatever its shapes weigh.
template <class Real>
void set_mass(WorldData<Real>& w, int body, const MassProperties& mass);

/// A shape is about to come to the body, or to go.
template <class Real>
void note_mass_change(WorldData<Real>& w, int body);
/// The body reaches at least as far as a shape that came to it.
template <class Real>
void grow_extents(WorldData<Real>& w, int body, int shape);
/// Sees to all that was noted.
template <class Real>
void settle(WorldData<Real>& w);
/// Whether something was noted that has not been seen to.
template <class Real>
bool is_unsettled(const WorldData<Real>& w, int body) {
  return w.bodies[body].half_width < 0;
}

/// What the body weighs, settled or not; the centre is in its frame.
template <class Real>
MassProperties mass_now(const WorldData<Real>& w, int body);
/// The way, m, from the body's frame to its centre of mass; none once it is settled.
template <class Real>
Vec2<Real> way_to_centre(const WorldData<Real>& w, int body);

/// Error (Value) where the densities of a body's shapes give it a mass that `Real` does not hold.
template <class Real>
void require_weights(const WorldData<Real>& w, int body);

/// Room for a new body's shapes to be seen from its centre of mass.
template <class Real>
void make_room_to_recentre(WorldData<Real>& w, std::span<const NewShape<Real>> shapes);

}  // namespace plumb
