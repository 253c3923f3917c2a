#pragma once

#include "engine/geometry/convex.h"

namespace plumb {

/// A circular part of an outline: the points at `radius` from `centre` whose outward normals lie
/// counter-clockwise from `from` to `to`, at most half a turn.
struct OutlineArc {
  Vec2d centre{};  ///< m
  double radius = 0;
  Vec2d from{}, to{};  ///< unit
};

/// Visits the outline of a convex shape counter-clockwise: `edge(start, end, normal)` for its straight parts,
/// `arc(OutlineArc)` for its round ones.
template <class Edge, class Arc>
void visit_outline(const Convex<double>& shape, Edge&& edge, Arc&& arc) {
  if (shape.count == 1) {
    const Vec2d centre = shape.corners[0].point;
    arc(OutlineArc{centre, shape.radius, {1, 0}, {-1, 0}});
    arc(OutlineArc{centre, shape.radius, {-1, 0}, {1, 0}});
    return;
  }
  for (int i = 0; i < shape.count; ++i) {
    const Corner<double>& corner = shape.corners[i];
    const Corner<double>& next = shape.corners[i + 1 < shape.count ? i + 1 : 0];
    const Vec2d offset = shape.radius * corner.normal;
    edge(corner.point + offset, next.point + offset, corner.normal);
    if (shape.radius > 0) arc(OutlineArc{next.point, shape.radius, corner.normal, next.normal});
  }
}

/// The part of an arc whose normals n have n . towards > 0: sines and cosines of its ends' angles from
/// `towards` (a unit vector).
struct FacingArc {
  double sine_from = 0, sine_to = 0, cosine_from = 0, cosine_to = 0;
};

inline FacingArc facing_part(const OutlineArc& arc, Vec2d towards) {
  const double c0 = dot(arc.from, towards), s0 = cross(towards, arc.from);
  const double c1 = dot(arc.to, towards), s1 = cross(towards, arc.to);
  // An arc of at most half a turn enters the facing half at sine -1 and leaves it at sine 1. With both ends
  // outside, its facing part is empty or the whole half.
  if (c0 <= 0 && c1 <= 0 && !(s0 < 0 && s1 > 0)) return {};
  FacingArc part{-1, 1, 0, 0};
  if (c0 > 0) part.sine_from = s0, part.cosine_from = c0;
  if (c1 > 0) part.sine_to = s1, part.cosine_to = c1;
  return part;
}

}  // namespace plumb
