#pragma once

#include <cstdint>

#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

namespace plumb {

/// A contact point of shapes a and b, or the place of their first contact, in the frame of a's body.
template <class Real>
struct ContactManifoldPoint {
  Vec2<Real> point{};         ///< m, half-way between the two surfaces
  Real separation = 0;        ///< m, negative where they overlap
  std::uint16_t feature = 0;  ///< the corners or edges in contact: the same while the contact persists
};

/// Stands for no face in ContactManifold::separating.
inline constexpr std::uint8_t kNoFace = 255;

/// Up to two points with one normal.
template <class Real>
struct ContactManifold {
  Vec2<Real> normal{};  ///< unit, from a to b
  int count = 0;
  /// Without points: the face along whose normal the shapes are apart, if one was found. An edge of a, or
  /// kMaxCorners more than one of b.
  std::uint8_t separating = kNoFace;
  ContactManifoldPoint<Real> points[2];
};
static_assert(2 * kMaxCorners <= kNoFace);

/// Computes the manifold of two rounded convex shapes. The corners of `a` are in the frame of a's body, those
/// of `b` in the frame of b's body, which lies at `b_in_a`. Points separated by more than `max_separation`
/// (m, >= 0) are left out. `pivot`, in a's frame, is the point about which a contact's impulses do not turn
/// the bodies relative to each other: the mean of their centres of mass, weighted by inverse inertia. On
/// outlines with nearly parallel edges, the two points are chosen on both sides of it.
template <class Real>
ContactManifold<Real> collide_convex(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                     Real max_separation, Vec2<Real> pivot);

/// Does the same for one segment of a chain. Only its front collides: the right side of the direction from
/// its first corner to its second. `before` and `after` are the neighbouring vertices of the chain, in a's
/// frame. The chain has no internal edges for sliding bodies: contacts with a normal that belongs to a
/// neighbour are left to that neighbour.
template <class Real>
ContactManifold<Real> collide_chain_segment(const Convex<Real>& segment, Vec2<Real> before, Vec2<Real> after,
                                            const Convex<Real>& b, const Pose<Real>& b_in_a,
                                            Real max_separation, Vec2<Real> pivot);

}  // namespace plumb
