#pragma once

#include "demos/window/canvas.h"

struct ImDrawData;
struct ImFontAtlas;

namespace plumb::window {

/// Paints what Dear ImGui has to draw onto a canvas, triangle by triangle, without graphics hardware. The
/// textures are the fonts of `atlas`; a pixel that two triangles share an edge in is painted once.
void rasterise(const ImDrawData& data, ImFontAtlas& atlas, Canvas& canvas);

}  // namespace plumb::window
