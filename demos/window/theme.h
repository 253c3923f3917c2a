#pragma once

#include "demos/window/canvas.h"
#include "engine/world/debug_draw.h"

namespace plumb::window {

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
