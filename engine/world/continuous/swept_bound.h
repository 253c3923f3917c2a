#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/world_data.h"

namespace plumb {

/// Lower bound on the separation of two shapes throughout the step, m; negative: largest penetration. Tests
/// one direction after the other. It is fast, computed in Real, and decides most pairs.
template <class Real>
class SweptBound {
 public:
  /// For the motions found by the solver. `enough`: the bound to reach, m.
  SweptBound(const WorldData<Real>& w, int shape, int other, Real enough)
      : a_(w, shape), b_(w, other), enough_(enough) {
    between_ = (w.position[a_.body] - w.position[b_.body]).template as<Real>();
    displacement_ = w.motion[a_.body].moved - w.motion[b_.body].moved;
    // Rotation to first order.
    const auto bend = [](const Side& side) { return Real(0.5) * side.turned * side.turned * side.reach; };
    rest_ = a_.convex.radius + b_.convex.radius + bend(a_) + bend(b_);
  }

  /// Tests a unit vector from `other` to `shape`. Returns true if the bound is reached.
  bool try_along(Vec2<Real> normal) {
    const Real here = dot(normal, between_), before = here - dot(normal, displacement_);
    const Span of_a = span(a_, -normal), of_b = span(b_, normal);
    const Real least = std::min(here - of_a.here - of_b.here, before - of_a.before - of_b.before) - rest_;
    if (least > least_) least_ = least;
    return least_ >= enough_;
  }
  /// Tests the normals of the edges, and the line between the centres.
  bool try_edges() {
    line_ = between_ + a_.rotation * middle(a_) - b_.rotation * middle(b_);
    if (try_edges_of(a_, -Real(1)) || try_edges_of(b_, Real(1))) return true;
    const Real length = std::sqrt(length_squared(line_));
    return length > 0 && try_along({line_.x / length, line_.y / length});
  }
  Real least() const { return least_; }

 private:
  struct Side {
    Side(const WorldData<Real>& w, int shape)
        : body(w.shapes[shape].body),
          convex(w.convex(shape)),
          rotation(w.rotation[body]),
          turned(w.motion[body].turned),
          reach(w.extents[body]) {}
    int body;
    Convex<Real> convex;
    Rotation<Real> rotation;  // at the end of the step
    Real turned, reach;
  };
  struct Span {
    Real here, before;  // m, support of a shape along a direction at the end and at the start of the step
  };

  static Span span(const Side& side, Vec2<Real> direction) {
    const Vec2<Real> n = side.rotation.inverse() * direction, m = n + side.turned * perpendicular(n);
    Vec2<Real> p = side.convex.corners[0].point;
    Span most{dot(n, p), dot(m, p)};
    for (int i = 1; i < side.convex.count; ++i) {
      p = side.convex.corners[i].point;
      most.here = std::max(most.here, dot(n, p)), most.before = std::max(most.before, dot(m, p));
    }
    return most;
  }
  static Vec2<Real> middle(const Side& side) {
    return Real(0.5) * (side.convex.corners[0].point + side.convex.corners[side.convex.count / 2].point);
  }
  bool try_edges_of(const Side& side, Real sign) {
    if (side.convex.count < 2) return false;
    for (int i = 0; i < side.convex.count; ++i) {
      const Vec2<Real> normal = sign * (side.rotation * side.convex.corners[i].normal);
      // Other edges face away.
      if (dot(normal, line_) < 0 && dot(normal, line_ - displacement_) < 0) continue;
      if (try_along(normal)) return true;
    }
    return false;
  }

  Side a_, b_;
  Real enough_, least_ = -std::numeric_limits<Real>::max();
  Vec2<Real> between_{};       // m, from b's centre of mass to a's at the end of the step
  Vec2<Real> displacement_{};  // m, its change in the step
  Vec2<Real> line_{};          // m, `between_` from centre to centre of the shapes, for `try_edges`
  Real rest_ = 0;
};

}  // namespace plumb
