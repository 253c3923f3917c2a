#pragma once

#include "engine/geometry/aabb.h"
#include "engine/math/vec2.h"

namespace plumb::window {

/// Visible part of the world, and its scale. Pixels: (0, 0) at the top left, y down; the world: m, y up.
class Camera {
 public:
  /// Sets the size of the picture, px. The middle stays fixed.
  void resize(int width, int height);
  /// Shows all of `view`, with a margin, above the scale bar, as large as possible between `left` px at the
  /// left and `right` px at the right.
  void fit(const Aabb<double>& view, double left = 0, double right = 0);

  Vec2d to_pixel(Vec2d point) const;
  Vec2d to_world(Vec2d pixel) const;
  double scale() const { return scale_; }  ///< px/m

  /// Scales by `factor`; the point at `pixel` stays fixed.
  void zoom(Vec2d pixel, double factor);
  void pan(Vec2d pixels);  ///< moves the picture by so much

  static constexpr double kSmallest = 1e-3, kLargest = 1e6;  ///< px/m

 private:
  int width_ = 1, height_ = 1;
  Vec2d centre_{};  // m, at the middle of the picture
  double scale_ = 50;
};

}  // namespace plumb::window
