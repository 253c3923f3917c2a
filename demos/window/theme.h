#pragma once

#include "demos/window/canvas.h"
#include "engine/world/debug_draw.h"

namespace plumb::window {

/// Colours on a dark or a light ground.
struct Theme {
  bool dark = true;

  Colour ground() const;
  Colour grid() const;
  Colour text() const;
  /// Of what stands for `role`.
  Paint paint(DrawRole role) const;
  /// Of the n-th engine whose motion is drawn over plumb's.
  Colour ghost(int n) const;
};

}  // namespace plumb::window
