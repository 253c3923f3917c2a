#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "demos/core/demo.h"
#include "demos/window/camera.h"
#include "demos/window/companion.h"
#include "demos/window/history.h"
#include "demos/window/series.h"
#include "demos/window/theme.h"

namespace plumb::window {

/// An open demo.
struct Show {
  std::unique_ptr<demos::Demo> demo;
  std::unique_ptr<Companion> companion{};  ///< may be null
};

/// A demo or scene that can be opened.
struct Item {
  std::string name, summary;
  std::function<Show()> make;
};

/// Effects of the window's keys, the same for all items.
enum class Command {
  Pause,
  Step,
  Back,
  Restart,
  Previous,
  Next,
  Panel,
  Code,
  Slow,
  Home,
  Picture,
  Scene,
  Quit
};

struct CommandKey {
  std::string_view key;  ///< "p", "tab", "escape", ...
  Command command;
  std::string_view label, about;
};

/// Returns all of them, in the order of the help.
std::span<const CommandKey> command_keys();

/// State and actions of the window, without the window itself: items, time, keys, pointer, camera.
class Player {
 public:
  Player(std::vector<Item> items, std::size_t first);

  const std::vector<Item>& items() const { return items_; }
  std::size_t place() const { return place_; }
  void open(std::size_t place);
  void choose(std::size_t place);  ///< the same, but errors are shown in `message`

  demos::Demo& demo() { return *show_.demo; }
  const demos::Demo& demo() const { return *show_.demo; }
  Companion* companion() { return show_.companion.get(); }

  /// Handles a key by its name: a key of the window, or else of the demo. Returns the command if it was one;
  /// pictures and quitting are left to the caller.
  std::optional<Command> key(std::string_view name);

  void press(Vec2d point);  ///< m, as below
  void drag(Vec2d point);
  void release(Vec2d point);
  void hover(Vec2d point);
  bool pressed() const { return pressed_; }
  void set(std::string_view control, double value);

  /// Advances by real time: not at all while paused, by a tenth of it in slow motion. The camera follows the
  /// motion unless the player has moved the camera or presses the pointer. An exception of the demo pauses it
  /// and is shown in `message`.
  void advance(double seconds);
  void step();
  /// Undoes the last step and pauses. Returns false if no earlier state is stored.
  bool back();
  void restart();

  /// Sets the size of the picture, and the widths that the panel at the left and the code at the right cover
  /// while they are shown, px.
  void resize(int width, int height, double panel_width, double code_width = 0);
  void home();  ///< shows the demo's part of the world, and follows the motion again
  void zoom(Vec2d pixel, double factor);
  void pan(Vec2d pixels);

  /// Returns the C++ of the open demo; for a scene, its initial state as JSON.
  const std::string& code_text() const { return code_text_; }

  const std::vector<Series>& series() const { return series_; }
  std::size_t remembered() const { return history_.size(); }

  bool strict = false;  ///< throws errors instead of showing them
  bool paused = false, slow = false, panel = true, code = false, sleep_shows = true;
  DrawOptions options{};
  demos::MotionOptions motion{};
  double frame_ms = 0;  ///< time of the last frame, steps and drawing; 0: not measured
  Theme theme{};
  Camera camera{};
  std::string message{};  ///< last message for the player

  static constexpr double kSlow = 0.1;

 private:
  void remember();  // stores a new state
  void sample();
  void follow(double seconds);
  void fit();
  template <class Act>
  void guarded(Act&& act);

  std::vector<Item> items_;
  std::size_t place_ = 0;
  Show show_;
  std::string code_text_;
  History history_;
  std::vector<Series> series_;
  bool pressed_ = false;
  bool at_home_ = true;   // true if the camera follows the demo: the player has not moved it
  Aabb<double> shown_{};  // m, part of the world that the following camera shows
  int width_ = 1, height_ = 1;
  double panel_width_ = 0, code_width_ = 0;
  bool panel_was_ = true, code_was_ = false;
};

}  // namespace plumb::window
