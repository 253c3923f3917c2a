#pragma once

#include "demos/window/canvas.h"

struct ImDrawData;
struct ImFontAtlas;

namespace plumb::window {

/// Converts a colour to ImGui's format.
constexpr std::uint32_t imgui_colour(Colour c) {
  return c.r | std::uint32_t{c.g} << 8 | std::uint32_t{c.b} << 16 | std::uint32_t{c.a} << 24;
}

/// Paints Dear ImGui's draw data onto a canvas in software, triangle by triangle. The textures are the fonts
/// of `atlas`. A pixel on an edge shared by two triangles is painted once.
void rasterise(const ImDrawData& data, ImFontAtlas& atlas, Canvas& canvas);

}  // namespace plumb::window
