#pragma once

#include <bitset>
#include <string_view>

#include "demos/window/canvas.h"
#include "demos/window/painter.h"
#include "demos/window/player.h"

struct ImGuiContext;

namespace plumb::window {

/// The pointer and the keyboard as the panel sees them.
struct PanelInput {
  Vec2d pointer{-1, -1};  ///< px
  bool left = false, right = false, control_key = false;
  double wheel = 0;
  double seconds = 1.0 / 60;  ///< since the frame before
  std::string_view text{};    ///< that was typed
};

/// Paints frames: the world, and over it the panel with its lists, sliders and plots. One at a time.
class Ui {
 public:
  Ui();
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  bool wants_keys() const;  ///< a text is being edited
  /// A key that edits text: "enter", "escape", "backspace", "left", ...
  void edit_key(std::string_view name, bool down);

  /// The picture of the player as it is; the panel may change it.
  void frame(Player& player, const PanelInput& input, Canvas& canvas);

  static constexpr double kPanelWidth = 360;  ///< px

 private:
  ImGuiContext* context_;
  bool dark_ = true;
  std::bitset<16> unseen_, over_;  // by edit key: pressed since the last frame; and let go since then
};

}  // namespace plumb::window
