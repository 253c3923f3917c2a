#pragma once

#include "demos/window/player.h"

namespace plumb::window {

/// The panel at the left: what there is to open, what can be set, what is measured, what is drawn. Call
/// between ImGui's NewFrame and Render.
void draw_panel(Player& player, double width);

/// The player's message, at the lower edge, and whether time stands still.
void draw_message(const Player& player);

}  // namespace plumb::window
