#pragma once

#include "engine/collide/contact_manifold.h"

/// Internal edges: where a surface is made of several shapes, the corners and sides at which they meet are no
/// part of it. What slides over them is to feel the surface of the union alone.
namespace plumb {

/// How a contact touches one of its two shapes, in the frame of that shape's body.
template <class Real>
struct TouchedSurface {
  Convex<Real> shape{};
  int edges = 0;         ///< the first so many can be touched: all, or the front of a chain's segment
  Vec2<Real> normal{};   ///< unit, out of the shape
  Vec2<Real> points[2];  ///< m, on its surface
  Vec2<Real> mover{};    ///< m, the middle of what touches it
  int count = 0;
  bool apart = false;  ///< by more than the tolerance
  /// m: steps and gaps in the surface that are none. Gaps may be three times as wide.
  Real tolerance = 0;
};

/// What a neighbour of the touched shape makes of the contact.
template <class Real>
struct SeamAnswer {
  enum class Kind : unsigned char {
    Own,     ///< the normal belongs to the union's surface
    Face,    ///< it does not, but that of a face of the shape does
    Hidden,  ///< the neighbour lies between
  };
  Kind kind = Kind::Own;
  int face = 0;
  bool at_start = false;  ///< the seam is at the face's first corner
  Real height = 0;        ///< m, of the mover's middle over the face
};

/// Asks whether the contact's normal is one of the union's surface. The neighbour's corners are given by its
/// own frame, which lies at `pose` in the shape's.
template <class Real>
SeamAnswer<Real> look_across_seam(const TouchedSurface<Real>& touched, const Convex<Real>& neighbour,
                                  int neighbour_edges, const Pose<Real>& pose);

/// The manifold of b with one face of a alone, which counts as longer by `slack` (m) at the given end.
template <class Real>
ContactManifold<Real> collide_face(const Convex<Real>& a, int face, bool at_start, Real slack,
                                   const Convex<Real>& b, const Pose<Real>& b_in_a, Real reach);

/// The manifold seen with the shapes in each other's place, found in the frame of b, in that of a.
template <class Real>
ContactManifold<Real> seen_from_other(const ContactManifold<Real>& found, const Pose<Real>& b_in_a);

}  // namespace plumb
