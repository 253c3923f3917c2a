#pragma once

#include "demos/window/player.h"

namespace plumb::window {

/// Draws the panel at the left: items, settings, figures, and kinds of drawings. Call between ImGui's
/// NewFrame and Render.
void draw_panel(Player& player, double width);

/// Draws the code of the demo, or the open scene, at the right.
void draw_code(const Player& player, double width);

/// Draws the player's message at the lower edge, after "paused" while time is paused.
void draw_message(const Player& player);

}  // namespace plumb::window
