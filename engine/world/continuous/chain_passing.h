#pragma once

#include "engine/collision/distance/time_of_impact.h"
#include "engine/geometry/convex.h"

namespace plumb {

/// A chain segment and a shape that meet: their corners, relative to the points that their sweeps move.
template <class Real>
struct ChainEncounter {
  const Convex<Real>&segment, &mover;
  const Sweep<double>&segment_sweep, &mover_sweep;
  Vec2<Real> before{}, after{};  ///< m, the chain's vertices beyond the segment, in its body's frame
  Vec2<Real> first{}, second{};  ///< m, its own vertices there
};

/// Returns true if a shape passes a chain segment instead of hitting its front, by the rule of contacts
/// (chain_segment.cpp): bodies that come from behind pass, and vertices between segments are no corners.
/// `point` and `normal` (out of the segment): in the world, at a fraction of both sweeps. `touches`: both are
/// those of an impact; otherwise the search ended before one.
template <class Real>
bool passes_chain(const ChainEncounter<Real>& e, Vec2d point, Vec2d normal, double fraction, bool touches);

}  // namespace plumb
