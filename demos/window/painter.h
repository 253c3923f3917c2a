#pragma once

#include <string>
#include <vector>

#include "demos/window/camera.h"
#include "demos/window/labels.h"
#include "demos/window/theme.h"
#include "engine/world/debug_draw.h"

namespace plumb::window {

/// Paints a world's debug drawing. Texts are collected for a caller that has a font.
class Painter : public DebugDraw {
 public:
  Painter(Canvas& canvas, const Camera& camera, const Theme& theme)
      : canvas_(canvas), camera_(camera), theme_(theme) {}

  bool sleep_shows = true;  ///< true if sleeping bodies have a colour of their own
  /// If alpha is not 0, draws only outlines of this colour, instead of the roles' colours.
  Colour outline{0, 0, 0, 0};

  void polygon(std::span<const Vec2d> corners, double radius, DrawRole role) override;
  void circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) override;
  void capsule(Vec2d start, Vec2d end, double radius, DrawRole role) override;
  void segment(Vec2d start, Vec2d end, DrawRole role) override;
  void point(Vec2d point, DrawRole role) override;
  void text(Vec2d point, std::string_view text, DrawRole role) override;

  /// Draws a grid with a spacing of 1, 2 or 5 times a power of ten m.
  void grid();
  /// Draws a bar at the lower right, `covered` px from the picture's edge, whose length is the spacing of the
  /// grid, and labels it with this length.
  void scale_bar(double covered = 0);

  /// Returns the colour of the n-th ghost.
  Colour ghost(int n) const { return theme_.ghost(n); }

  const std::vector<Label>& labels() const { return labels_; }

 private:
  Paint paint_of(DrawRole role) const;
  void shape(std::span<const Vec2d> corners, double radius, DrawRole role);

  Canvas& canvas_;
  const Camera& camera_;
  const Theme& theme_;
  std::vector<Label> labels_;
  std::vector<Vec2d> pixels_;
};

}  // namespace plumb::window
