#pragma once

#include "engine/collision/manifold/contact_manifold.h"

/// Internal edges: on a surface made of several shapes, the corners and sides at which they meet are not part
/// of the surface. Sliding bodies must feel the surface of the union alone.
namespace plumb {

/// A contact's part on one of its two shapes, in the frame of that shape's body.
template <class Real>
struct TouchedSurface {
  Convex<Real> shape{};
  int edges = 0;            ///< number of edges that can be touched: all, or 1 for a chain segment
  Vec2<Real> normal{};      ///< unit, out of the shape
  Vec2<Real> points[2];     ///< m, on its surface
  Convex<Real> mover{};     ///< the shape that touches it, in the frame of its own body
  Pose<Real> mover_pose{};  ///< that frame's pose
  int count = 0;
  bool apart = false;  ///< separated by more than the tolerance
  /// Steps and gaps of the surface up to this are ignored, m; gaps may be three times as wide.
  Real tolerance = 0;
};

/// How a neighbour of the touched shape changes the contact.
template <class Real>
struct InternalEdgeResult {
  enum class Kind : unsigned char {
    Own,     ///< the normal belongs to the union's surface
    Face,    ///< the normal does not, but that of a face of the shape does
    Hidden,  ///< the neighbour lies between the shapes
  };
  Kind kind = Kind::Own;
  int face = 0;
  bool at_start = false;  ///< the seam is at the face's first corner
  Real height = 0;        ///< m, of the mover's middle over the face
};

/// Tests whether the contact's normal is one of the union's surface. The neighbour's corners are in its own
/// frame, which lies at `pose` in the shape's.
template <class Real>
InternalEdgeResult<Real> check_internal_edge(const TouchedSurface<Real>& touched,
                                             const Convex<Real>& neighbour, int neighbour_edges,
                                             const Pose<Real>& pose);

/// Computes the manifold of b with one face of a alone, extended by `slack` (m) at the given end; `pivot` as
/// in collide_convex.
template <class Real>
ContactManifold<Real> collide_face(const Convex<Real>& a, int face, bool at_start, Real slack,
                                   const Convex<Real>& b, const Pose<Real>& b_in_a, Real max_separation,
                                   Vec2<Real> pivot);

/// Converts a manifold found with the shapes swapped, in the frame of b, to that of a.
template <class Real>
ContactManifold<Real> swapped_manifold(const ContactManifold<Real>& found, const Pose<Real>& b_in_a);

}  // namespace plumb
