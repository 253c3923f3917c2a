#pragma once

#include <string>

#include "engine/world/debug_draw.h"

namespace plumb::demos {

/// Draws an arrow, its head a fifth of its length.
void draw_arrow(DebugDraw& out, Vec2d from, Vec2d to, DrawRole role);

/// Returns a mass as text: "10 kg".
std::string mass_text(double mass);

}  // namespace plumb::demos
