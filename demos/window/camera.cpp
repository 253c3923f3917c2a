#include "demos/window/camera.h"

#include <algorithm>

namespace plumb::window {

void Camera::resize(int width, int height) { width_ = std::max(width, 1), height_ = std::max(height, 1); }

void Camera::fit(const Aabb<double>& view, double left, double right) {
  constexpr double kMargin = 16;  // px
  constexpr double kBelow = 36;   // px, the height of the scale bar, which would cover bodies
  const double wide = std::max(width_ - left - right - 2 * kMargin, 1.0);
  const double high = std::max(height_ - kMargin - kBelow, 1.0);
  const Vec2d size = view.upper - view.lower;
  const double across = size.x > 0 ? wide / size.x : kLargest, up = size.y > 0 ? high / size.y : kLargest;
  scale_ = std::clamp(std::min(across, up), kSmallest, kLargest);
  // Shows the middle of the view at the middle of the area between the panels.
  centre_ = 0.5 * (view.lower + view.upper) + Vec2d{right - left, kMargin - kBelow} * (0.5 / scale_);
}

Vec2d Camera::to_pixel(Vec2d point) const {
  return {0.5 * width_ + scale_ * (point.x - centre_.x), 0.5 * height_ - scale_ * (point.y - centre_.y)};
}

Vec2d Camera::to_world(Vec2d pixel) const {
  return {centre_.x + (pixel.x - 0.5 * width_) / scale_, centre_.y - (pixel.y - 0.5 * height_) / scale_};
}

void Camera::zoom(Vec2d pixel, double factor) {
  const Vec2d held = to_world(pixel);
  scale_ = std::clamp(scale_ * factor, kSmallest, kLargest);
  centre_ = centre_ + held - to_world(pixel);
}

void Camera::pan(Vec2d pixels) { centre_ = centre_ + Vec2d{-pixels.x, pixels.y} * (1 / scale_); }

}  // namespace plumb::window
