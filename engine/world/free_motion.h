#pragma once

#include "engine/world/world_data.h"

/// How awake bodies move of their own accord, whatever the solver: gravity, forces, damping and locks give
/// each a kick a substep, and its velocity carries it.
namespace plumb {

/// What becomes of bodies that neither a contact nor a joint holds.
enum class FreeFlight {
  Exact,     ///< a parabola through the whole step at once
  Substeps,  ///< like all others: v += h a, x += h v
};

/// At the step's start: the kick of each body for substeps of length `h`, and nothing has moved yet. Bodies
/// in exact flight have arrived.
template <class Real>
void prepare_kicks(WorldData<Real>& w, double h, int substeps, FreeFlight flight);

/// v += h a.
template <class Real>
void integrate_velocities(WorldData<Real>& w);

/// The same, and all that constraints gave each body in the substep before once more: where normals and arms
/// stay what they are, that is a warm start of them all, for the price of the bodies.
template <class Real>
void repeat_velocities(WorldData<Real>& w);

/// x += h v. In exact flight a body without joints that nothing has pressed in the substep moves on its
/// parabola: what is merely near others falls as what is alone.
template <class Real>
void integrate_positions(WorldData<Real>& w, Real h, FreeFlight flight);

/// Takes back what projections moved bodies along locked axes: nothing moves there in a step.
template <class Real>
void hold_locks(WorldData<Real>& w);

/// m/s^2, of a dynamic body that nothing holds: its weight and what the user applies to it.
template <class Real>
Vec2d free_acceleration(const WorldData<Real>& w, int body);

/// m/s, the slowest approach that bounces in a step of `dt`: at rest bodies gain |gravity| dt before a
/// contact answers.
template <class Real>
Real bounce_threshold(const WorldData<Real>& w, double dt);

}  // namespace plumb
