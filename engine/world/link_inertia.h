#pragma once

#include "engine/world/world_data.h"

/// Light links under a heavy load. A joint's force turns with the link that it pulls at, and brings it back
/// into line: per rad by the torque k = F . r, r from the link's centre to the joint. A substep h takes the
/// force as it stands at its start, which is the semi-implicit Euler method for these modes, sqrt(k / I)
/// fast: stable for h sqrt(k / I) < 2. What the step cannot follow is therefore given so much inertia that it
/// can:
///     I' = max(I, h^2 k).
/// This is the mass matrix of the linearly implicit step, M + h^2 K, in the form that takes no energy out of
/// slow motion: only changes of the velocity meet it. K is its diagonal (Tournier, Nesme, Gilles and Faure,
/// Stable constrained dynamics, ACM Transactions on Graphics 34, 2015). Slow motion sees links that are
/// heavier by h^2 k / I, some 1e-4 of the load that pulls at them: the error is of second order in h.
namespace plumb {

/// The bodies of the island, with what they are without a load.
template <class Real>
void find_links(WorldData<Real>& w, DirectIsland<Real>& island);

/// Gives links the inertia for the loads of the rows' impulses and a substep of h, s.
template <class Real>
void load_links(WorldData<Real>& w, DirectIsland<Real>& island, Real h);

/// What a joint's two bodies turn relative to each other, by the share of their inertia that the load made,
/// is taken out: fast modes gain energy where loads change within their period. Angular momentum stays.
template <class Real>
void damp_links(WorldData<Real>& w, DirectIsland<Real>& island);

/// Links are again what they are without a load.
template <class Real>
void restore_links(WorldData<Real>& w, DirectIsland<Real>& island);

}  // namespace plumb
