#pragma once

#include <bitset>
#include <string_view>

#include "demos/window/canvas.h"
#include "demos/window/painter.h"
#include "demos/window/player.h"

struct ImGuiContext;

namespace plumb::window {

/// Pointer and keyboard input of the panel.
struct PanelInput {
  Vec2d pointer{-1, -1};  ///< px
  bool left = false, right = false, control_key = false;
  double wheel = 0;
  double seconds = 1.0 / 60;  ///< since the previous frame
  std::string_view text{};    ///< typed since then
};

/// Paints frames: the world, and over it the panel with its lists, sliders and plots. One instance at a time.
class Ui {
 public:
  Ui();
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  bool wants_keys() const;  ///< true while a text is being edited
  /// Handles a key that edits text: "enter", "escape", "backspace", "left", ...
  void edit_key(std::string_view name, bool down);

  /// Paints the player's current state; the panel may change it.
  void frame(Player& player, const PanelInput& input, Canvas& canvas);

  static constexpr double kPanelWidth = 360;  ///< px
  /// Returns the width of the code at the right of a picture, px, chosen such that the demo has enough space.
  static double code_width(double width) { return width < 1000 ? 0.4 * width : 0.55 * (width - kPanelWidth); }

 private:
  ImGuiContext* context_;
  bool dark_ = true;
  std::bitset<16> unseen_, over_;  // one bit per edit key: pressed since the last frame; released since then
};

}  // namespace plumb::window
