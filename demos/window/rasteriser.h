#pragma once

#include "demos/window/canvas.h"

struct ImDrawData;
struct ImFontAtlas;

namespace plumb::window {

/// A colour as ImGui has it.
constexpr std::uint32_t imgui_colour(Colour c) {
  return c.r | std::uint32_t{c.g} << 8 | std::uint32_t{c.b} << 16 | std::uint32_t{c.a} << 24;
}

/// Paints what Dear ImGui has to draw onto a canvas, triangle by triangle, without graphics hardware. The
/// textures are the fonts of `atlas`; a pixel that two triangles share an edge in is painted once.
void rasterise(const ImDrawData& data, ImFontAtlas& atlas, Canvas& canvas);

}  // namespace plumb::window
