#pragma once

#include "engine/world/world_data.h"

/// Integration of the awake bodies, common to all solvers. In each substep gravity, forces, damping and locks
/// change the velocity, and the velocity moves the body.
namespace plumb {

/// Returns the changes of a body's velocities by gravity, loads and damping in `time`, s: exact for a
/// constant acceleration a and a damping c, v' = e^-x v + (1 - e^-x) / x t a with x = c t. So the terminal
/// speed is a / c for every length of the substep.
template <class Real>
VelocityIncrement<Real> velocity_increment_of(const WorldData<Real>& w, int body, double time);

/// Computes the velocity increments for substeps of length `h`, and resets displacements, at the step's
/// start. With velocity Verlet, bodies without contact points and joints are moved along a parabola through
/// the whole step.
template <class Real>
void prepare_integration(WorldData<Real>& w, double h, int substeps, Integrator integrator);

/// Spreads the changes of kinematic bodies' velocities since the last step over the substeps of this one: the
/// velocity in them rises by equal parts about the given one, which stays the mean. Such a body means a
/// motion through poses. With its whole change at the step's start, bodies on a platform that accelerates at
/// a carried a dt in the first substep and their weight alone in the others, and flew for 2 a / g of each
/// step on its way down: stacks and pyramids walked apart. A change above |gravity| dt is spread up to that
/// only, for rotation at the body's farthest point: the ramp itself then throws nothing off. Call it after
/// `prepare_integration`; returns true if there are any, for `end_kinematic_ramps`.
template <class Real>
bool ramp_kinematic_velocities(WorldData<Real>& w, double h, int substeps);

/// Gives kinematic bodies the velocities and displacements of the step that they were given.
template <class Real>
void end_kinematic_ramps(WorldData<Real>& w, double h, int substeps);

/// Integrates velocities: v += h a.
template <class Real>
void integrate_velocities(WorldData<Real>& w);

/// Integrates velocities, and adds again the velocity that constraints gave each body in the last substep.
/// This warm starts all constraints, as long as normals and lever arms are constant, at the cost of one loop
/// over the bodies.
template <class Real>
void integrate_and_warm_start(WorldData<Real>& w);

/// Integrates positions: x += h v. A body without joints that had no impulse in the substep moves with the
/// integrator's mean of the velocities before and after the increment, so that bodies with separated contacts
/// fall like bodies without contacts.
template <class Real>
void integrate_positions(WorldData<Real>& w, Real h, Integrator integrator);

/// Resets displacement and velocity along locked axes, which position projections may have changed.
template <class Real>
void enforce_motion_locks(WorldData<Real>& w);

/// Returns the acceleration that weight and load would give a dynamic body without constraints, m/s^2.
template <class Real>
Vec2d free_acceleration(const WorldData<Real>& w, int body);

/// Returns the lowest approach speed that bounces in a step of `dt`, m/s. Bodies at rest gain |gravity| dt
/// before a contact acts, so it depends on `dt`.
template <class Real>
Real bounce_threshold(const WorldData<Real>& w, double dt);

}  // namespace plumb
