#pragma once

#include <string>

#include "engine/geometry/aabb.h"
#include "engine/world/debug_draw.h"

namespace plumb {

/// Draws an SVG picture with roles as CSS classes, so that a style sheet may change their colours. Later
/// elements cover earlier ones.
class SvgDraw : public DebugDraw {
 public:
  void polygon(std::span<const Vec2d> corners, double radius, DrawRole role) override;
  void circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) override;
  void capsule(Vec2d start, Vec2d end, double radius, DrawRole role) override;
  void segment(Vec2d start, Vec2d end, DrawRole role) override;
  void point(Vec2d point, DrawRole role) override;
  void text(Vec2d point, std::string_view text, DrawRole role) override;

  /// Returns the picture of all elements so far, `width` pixels wide: of `view`, m, or of everything.
  std::string picture(int width = 800) const;
  std::string picture(const Aabb<double>& view, int width) const;

 private:
  void extend_bounds(Vec2d point, double radius);

  std::string body_;
  Aabb<double> bounds_{};
  bool empty_ = true;
};

/// Returns the role's CSS class: "static", "kinematic", ...
std::string_view name_of(DrawRole role);

}  // namespace plumb
