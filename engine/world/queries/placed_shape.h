#pragma once

#include <memory>

#include "engine/world/world_data.h"

namespace plumb {

/// Returns the body's rotation in double, normalised by one Newton step from its Real value.
template <class Real>
Rotation<double> exact_rotation(const WorldData<Real>& w, int body) {
  const double c = static_cast<double>(w.rotation[body].c), s = static_cast<double>(w.rotation[body].s);
  const double scale = 1.5 - 0.5 * (c * c + s * s);
  return {scale * c, scale * s};
}

/// A shape of the world in double precision, in the world's axes and relative to the point `seen_from`.
/// Queries near that point lose no precision far from the origin.
class PlacedShape {
 public:
  template <class Real>
  PlacedShape(const WorldData<Real>& w, int shape, Vec2d seen_from)
      : count_(w.forms[shape].count), radius_(static_cast<double>(w.forms[shape].radius)) {
    const Convex<Real> local = w.convex(shape);
    const int body = w.shapes[shape].body;
    const Rotation<double> q = exact_rotation(w, body);
    const Vec2d offset = w.position[body] - seen_from;
    for (int i = 0; i < count_; ++i) {
      std::construct_at(corners_ + i,
                        Corner<double>{offset + q * local.corners[i].point.template as<double>(),
                                       q * local.corners[i].normal.template as<double>()});
    }
  }
  PlacedShape(const PlacedShape&) = delete;
  PlacedShape& operator=(const PlacedShape&) = delete;

  Convex<double> convex() const { return {corners_, count_, radius_}; }

 private:
  union {
    Corner<double> corners_[kMaxCorners];  // only the first `count_` are constructed
  };
  int count_;
  double radius_;
};

}  // namespace plumb
