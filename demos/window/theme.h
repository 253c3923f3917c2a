#pragma once

#include <cstdint>

#include "demos/window/canvas.h"
#include "engine/world/debug_draw.h"

namespace plumb::window {

/// Opacity, of 255, of the plates behind texts over the picture: the picture shows through.
constexpr std::uint8_t kPlateAlpha = 215;

/// Colours on a dark or a light background.
struct Theme {
  bool dark = true;

  Colour ground() const;
  Colour grid() const;
  Colour text() const;
  /// Returns the paint of `role`.
  Paint paint(DrawRole role) const;
  /// Returns the colour of the n-th engine drawn over plumb's motion.
  Colour ghost(int n) const;
};

}  // namespace plumb::window
