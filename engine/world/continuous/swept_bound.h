#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/world_data.h"

namespace plumb {

/// Computes a lower bound on the separation of two shapes throughout the step, m (negative: penetration), by
/// separating axes. It is fast, because it is computed in Real, and decides most pairs.
template <class Real>
class SweptBound {
 public:
  /// Uses the solver's motions. `threshold`: the bound to reach, m.
  SweptBound(const WorldData<Real>& w, int shape, int other, Real threshold)
      : a_(w, shape), b_(w, other), threshold_(threshold) {
    offset_ = (w.position[a_.body] - w.position[b_.body]).template as<Real>();
    displacement_ = w.motion[a_.body].delta_position - w.motion[b_.body].delta_position;
    // Rotation to first order.
    const auto rotation_error = [](const SweptShape& swept) {
      return Real(0.5) * swept.turned * swept.turned * swept.extent;
    };
    margin_ = a_.convex.radius + b_.convex.radius + rotation_error(a_) + rotation_error(b_);
  }

  /// Tests an axis, a unit vector from `other` to `shape`. Returns true if the bound is reached.
  bool test_axis(Vec2<Real> normal) {
    const Real at_end = dot(normal, offset_), at_start = at_end - dot(normal, displacement_);
    const Support of_a = support(a_, -normal), of_b = support(b_, normal);
    const Real separation =
        std::min(at_end - of_a.at_end - of_b.at_end, at_start - of_a.at_start - of_b.at_start) - margin_;
    if (separation > lower_bound_) lower_bound_ = separation;
    return lower_bound_ >= threshold_;
  }
  /// Tests the normals of the edges, and the line between the centres.
  bool test_edge_normals() {
    centre_line_ = offset_ + a_.rotation * centre(a_) - b_.rotation * centre(b_);
    if (test_edge_normals_of(a_, -Real(1)) || test_edge_normals_of(b_, Real(1))) return true;
    const Real length = std::sqrt(length_squared(centre_line_));
    return length > 0 && test_axis({centre_line_.x / length, centre_line_.y / length});
  }
  Real lower_bound() const { return lower_bound_; }

 private:
  struct SweptShape {
    SweptShape(const WorldData<Real>& w, int shape)
        : body(w.shapes[shape].body),
          convex(w.convex(shape)),
          rotation(w.rotation[body]),
          turned(w.motion[body].delta_angle),
          extent(w.extents[body]) {}
    int body;
    Convex<Real> convex;
    Rotation<Real> rotation;  // at the end of the step
    Real turned, extent;
  };
  struct Support {
    Real at_end, at_start;  // m, support of a shape at the end and at the start of the step
  };

  static Support support(const SweptShape& shape, Vec2<Real> direction) {
    const Vec2<Real> n = shape.rotation.inverse() * direction, m = n + shape.turned * perpendicular(n);
    Vec2<Real> p = shape.convex.corners[0].point;
    Support result{dot(n, p), dot(m, p)};
    for (int i = 1; i < shape.convex.count; ++i) {
      p = shape.convex.corners[i].point;
      result.at_end = std::max(result.at_end, dot(n, p)),
      result.at_start = std::max(result.at_start, dot(m, p));
    }
    return result;
  }
  static Vec2<Real> centre(const SweptShape& shape) {
    return Real(0.5) * (shape.convex.corners[0].point + shape.convex.corners[shape.convex.count / 2].point);
  }
  bool test_edge_normals_of(const SweptShape& shape, Real sign) {
    if (shape.convex.count < 2) return false;
    for (int i = 0; i < shape.convex.count; ++i) {
      const Vec2<Real> normal = sign * (shape.rotation * shape.convex.corners[i].normal);
      // Other edges face away.
      if (dot(normal, centre_line_) < 0 && dot(normal, centre_line_ - displacement_) < 0) continue;
      if (test_axis(normal)) return true;
    }
    return false;
  }

  SweptShape a_, b_;
  Real threshold_, lower_bound_ = -std::numeric_limits<Real>::max();
  Vec2<Real> offset_{};        // m, from b's centre of mass to a's at the end of the step
  Vec2<Real> displacement_{};  // m, its change in the step
  Vec2<Real> centre_line_{};   // m, `offset_` between the centres of the shapes instead
  Real margin_ = 0;
};

}  // namespace plumb
