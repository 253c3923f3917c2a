#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "engine/geometry/convex_bounds.h"

namespace plumb {

/// A shape shrunk by a uniform depth: all its points deeper than that below its surface. As long as the core
/// has not passed through anything, the direction of least penetration leads back to the side that the shape
/// came from. The depth is subtracted from the rounding radius first, then from the edges.
template <class Real>
class Core {
 public:
  Core(const Convex<Real>& shape, Real depth) {
    const Real from_radius = std::min(depth, shape.radius), from_edges = depth - from_radius;
    convex_ = {corners_, 0, shape.radius - from_radius};
    if (shape.count < 3 || !(from_edges > 0)) {
      for (int i = 0; i < shape.count; ++i) add(shape.corners[i]);
    } else if (!inset_corners(shape, from_edges)) {
      cut_edges(shape, from_edges);
    }
  }
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;
  const Convex<Real>& convex() const { return convex_; }

 private:
  void add(const Corner<Real>& corner) { std::construct_at(corners_ + convex_.count++, corner); }

  // Moves each corner inwards along its bisector. Returns false if an edge would reverse: it has to vanish.
  bool inset_corners(const Convex<Real>& shape, Real depth) {
    convex_.count = 0;
    for (int i = 0; i < shape.count; ++i) {
      const Vec2<Real> before = shape.corners[i > 0 ? i - 1 : shape.count - 1].normal,
                       after = shape.corners[i].normal;
      const Real scale = 1 + dot(before, after);
      if (!(scale > Real(1e-6))) return false;
      add({shape.corners[i].point - (depth / scale) * (before + after), after});
    }
    for (int i = 0; i < shape.count; ++i) {
      const Vec2<Real> along = perpendicular(shape.corners[i].normal);
      if (!(dot(along, corners_[i + 1 < shape.count ? i + 1 : 0].point - corners_[i].point) > 0))
        return false;
    }
    return true;
  }

  // Clips the shape against each of its edges, moved inwards.
  void cut_edges(const Convex<Real>& shape, Real depth) {
    Corner<Real> cut[kMaxCorners + 1];
    convex_.count = 0;
    for (int i = 0; i < shape.count; ++i) add(shape.corners[i]);
    for (int edge = 0; edge < shape.count; ++edge) {
      const Vec2<Real> normal = shape.corners[edge].normal;
      const Real most = dot(normal, shape.corners[edge].point) - depth;
      int count = 0;
      for (int i = 0; i < convex_.count; ++i) {
        const Corner<Real>&from = corners_[i], &to = corners_[i + 1 < convex_.count ? i + 1 : 0];
        const Real here = dot(normal, from.point) - most, there = dot(normal, to.point) - most;
        if (here <= 0) cut[count++] = from;
        if ((here > 0) != (there > 0) && count <= kMaxCorners) {
          const Vec2<Real> point = from.point + (here / (here - there)) * (to.point - from.point);
          cut[count++] = {point, here > 0 ? from.normal : normal};
        }
      }
      if (count == 0 || count > kMaxCorners) break;  // nothing is that deep: keep the inner corners
      convex_.count = count;
      std::copy(cut, cut + count, corners_);
    }
  }

  union {
    Corner<Real> corners_[kMaxCorners];  // only the first `convex_.count` are constructed
  };
  Convex<Real> convex_;
};

/// Returns half the width of a shape for tunnelling, m: a shape that moves by no more than this in a step
/// passes through nothing. It is half of the least width, and less for a shape with a sharp tip. A core of
/// half that depth thus reaches into the tip to within kTipLoss times half the width.
template <class Real>
Real convex_tunnelling_width(const Convex<Real>& shape) {
  constexpr Real kTipLoss = Real(1);
  const Real half_width = convex_half_width(shape);
  if (shape.count < 3) return half_width;
  const Real depth = half_width / 2;
  const Core<Real> core(shape, depth);
  const Convex<Real>& inner = core.convex();
  Real lost = 0;  // m^2, from a corner to the core
  for (int i = 0; i < shape.count; ++i) {
    const Vec2<Real> from = shape.corners[i].point;
    Real least = std::numeric_limits<Real>::max();
    for (int j = 0; j < inner.count; ++j)
      least = std::min(least, length_squared(inner.corners[j].point - from));
    lost = std::max(lost, least);
  }
  const Real most = kTipLoss * half_width + shape.radius;
  return lost > most * most ? half_width * (most / std::sqrt(lost)) : half_width;
}

}  // namespace plumb
