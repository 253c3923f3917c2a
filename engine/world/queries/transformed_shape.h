#pragma once

#include <memory>

#include "engine/world/world_data.h"

namespace plumb {

/// Returns the body's rotation in double, normalised by one Newton step from its Real value.
template <class Real>
Rotation<double> normalised_rotation(const WorldData<Real>& w, int body) {
  const double c = static_cast<double>(w.rotation[body].c), s = static_cast<double>(w.rotation[body].s);
  const double scale = 1.5 - 0.5 * (c * c + s * s);
  return {scale * c, scale * s};
}

/// A shape of the world in double precision, rotated to the world's axes and relative to the point `origin`,
/// so that queries near `origin` lose no precision far from the world's origin.
class TransformedShape {
 public:
  template <class Real>
  TransformedShape(const WorldData<Real>& w, int shape, Vec2d origin)
      : count_(w.forms[shape].count), radius_(static_cast<double>(w.forms[shape].radius)) {
    const Convex<Real> local = w.convex(shape);
    const int body = w.shapes[shape].body;
    const Rotation<double> q = normalised_rotation(w, body);
    const Vec2d offset = w.position[body] - origin;
    for (int i = 0; i < count_; ++i) {
      std::construct_at(corners_ + i,
                        Corner<double>{offset + q * local.corners[i].point.template as<double>(),
                                       q * local.corners[i].normal.template as<double>()});
    }
  }
  TransformedShape(const TransformedShape&) = delete;
  TransformedShape& operator=(const TransformedShape&) = delete;

  Convex<double> convex() const { return {corners_, count_, radius_}; }

 private:
  union {
    Corner<double> corners_[kMaxCorners];  // only the first `count_` are constructed
  };
  int count_;
  double radius_;
};

}  // namespace plumb
