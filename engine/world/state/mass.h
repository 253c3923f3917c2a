#pragma once

#include <span>

#include "engine/world/state/new_shape.h"
#include "engine/world/world_data.h"

/// Masses, centres of mass and sizes of bodies, computed from their shapes.
/// The frame of a dynamic body is at its centre of mass. That of a kinematic one is at its origin, about
/// which it rotates. A static body's frame stays at the centre of its first shapes, because its mass is not
/// needed; so adding a shape to a static body, or removing one, has constant cost. For other bodies, changes
/// of shapes are recorded, and all masses are computed together when they are needed: before a step, and
/// before calls that act on motions.
namespace plumb {

/// Recomputes a body's mass, centre and sizes, and moves its frame to the centre.
template <class Real>
void update_mass(WorldData<Real>& w, int body);
/// Does the same for a body whose type has changed.
template <class Real>
void update_mass_for_type(WorldData<Real>& w, int body);
/// Sets a body's mass, which replaces that of its shapes from now on.
template <class Real>
void set_mass(WorldData<Real>& w, int body, const MassProperties& mass);

/// Returns the inverse mass of a dynamic body, 1/kg; 0 if both its axes are locked, because no direction is
/// then free.
template <class Real>
Real inverse_mass_of(const BodyRecord<Real>& record, double mass);

/// Records that a shape is about to be added to the body or removed from it.
template <class Real>
void record_mass_change(WorldData<Real>& w, int body);
/// Grows the body's sizes by a shape that was added.
template <class Real>
void grow_extents(WorldData<Real>& w, int body, int shape);
/// Updates the masses of all bodies with a recorded change.
template <class Real>
void apply_mass_changes(WorldData<Real>& w);
/// Returns true if a change of the body's shapes was recorded and not yet applied.
template <class Real>
bool has_mass_change(const WorldData<Real>& w, int body) {
  return w.bodies[body].half_width < 0;
}

/// Returns the body's mass properties, including a recorded change; the centre is in the body's frame.
template <class Real>
MassProperties current_mass(const WorldData<Real>& w, int body);
/// Returns the offset of the body's centre of mass from its stored one, m; 0 if no change was recorded.
template <class Real>
Vec2<Real> centre_of_mass_shift(const WorldData<Real>& w, int body);

/// Throws Error (Value) if the densities of a body's shapes give a mass that `Real` cannot hold.
template <class Real>
void require_float_masses(const WorldData<Real>& w, int body);

/// Reserves memory to move a new body's shapes into the frame of its centre of mass.
template <class Real>
void reserve_recentring(WorldData<Real>& w, std::span<const NewShape<Real>> shapes);

}  // namespace plumb
