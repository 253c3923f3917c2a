#include "engine/world/continuous/chain_passing.h"

#include <cmath>

#include "engine/collision/manifold/chain_neighbour.h"

namespace plumb {
namespace {

// Returns the velocity of a body's point, m per interval.
Vec2d velocity_at(const Sweep<double>& sweep, const Pose<double>& pose, double fraction, Vec2d point) {
  return sweep.motion + (2 * fraction) * sweep.curve +
         sweep.delta_angle * perpendicular(point - pose.position);
}

}  // namespace

template <class Real>
bool passes_chain(const ChainEncounter<Real>& e, Vec2d point, Vec2d normal, double fraction, bool touches) {
  const Pose<double> pose = pose_at(e.segment_sweep, fraction);
  const Rotation<double> back = pose.rotation.inverse();
  const Vec2d own = e.segment.corners[0].normal.template as<double>(), local = back * normal;
  if (dot(own, local) < 0) return true;
  const double tilt = dot(perpendicular(own), local);
  if (!touches || std::abs(tilt) <= kFlatBend) return false;
  const bool at_first = tilt < 0;
  const auto vertex = [](Vec2<Real> v) { return v.template as<double>(); };
  const ChainNeighbour<double> end = chain_neighbour(vertex(at_first ? e.first : e.second),
                                                     vertex(at_first ? e.before : e.after), own, at_first);
  // The neighbour has the surface beyond the bend. A shape that meets the vertex alone from there is in it
  // already: it passes from behind, or the neighbour's contact pushes it out.
  if (!end.open && !end.hollow) return !is_within_bend(end, local, at_first);
  if (!end.open && e.mover.count == 1) return true;
  const Pose<double> mover_pose = pose_at(e.mover_sweep, fraction);
  const Vec2d first = pose.position + pose.rotation * vertex(e.segment.corners[0].point);
  Vec2d sum{};
  for (int i = 0; i < e.mover.count; ++i)
    sum += mover_pose.position + mover_pose.rotation * vertex(e.mover.corners[i].point) - first;
  const Vec2d front = pose.rotation * own;
  if (dot(front, sum) < 0) return true;
  if (end.open) return false;
  // In a hollow the contact acts along the segment's own normal.
  return dot(front, velocity_at(e.mover_sweep, mover_pose, fraction, point) -
                        velocity_at(e.segment_sweep, pose, fraction, point)) >= 0;
}

#define PLUMB_FOR(Real) template bool passes_chain(const ChainEncounter<Real>&, Vec2d, Vec2d, double, bool);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
