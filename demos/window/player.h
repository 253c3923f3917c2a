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

/// A demo on the stage.
struct Show {
  std::unique_ptr<demos::Demo> demo;
  std::unique_ptr<Companion> companion{};  ///< may be null
};

/// Something that can be opened.
struct Item {
  std::string name, summary;
  std::function<Show()> make;
};

/// What a key of the window does, whatever is open.
enum class Command { Pause, Step, Back, Restart, Previous, Next, Panel, Slow, Home, Picture, Quit };

struct CommandKey {
  std::string_view key;  ///< "p", "tab", "escape", ...
  Command command;
  std::string_view label, about;
};

/// All of them, in the order of the help.
std::span<const CommandKey> command_keys();

/// What there is to play with and what is done with it, without a window: time, keys, pointer, camera.
class Player {
 public:
  Player(std::vector<Item> items, std::size_t first);

  const std::vector<Item>& items() const { return items_; }
  std::size_t place() const { return place_; }
  void open(std::size_t place);
  void choose(std::size_t place);  ///< likewise; what goes wrong is said in `message`

  demos::Demo& demo() { return *show_.demo; }
  const demos::Demo& demo() const { return *show_.demo; }
  Companion* companion() { return show_.companion.get(); }

  /// A key by its name: the window's own, or else the demo's. Pictures and quitting are the caller's:
  /// returns the command, if it was one.
  std::optional<Command> key(std::string_view name);

  void press(Vec2d point);  ///< m; likewise the others
  void drag(Vec2d point);
  void release(Vec2d point);
  void hover(Vec2d point);
  bool pressed() const { return pressed_; }
  void set(std::string_view control, double value);

  /// Lets real time pass: nothing while paused, a tenth of it in slow motion. What the demo throws pauses it
  /// and is said in `message`.
  void advance(double seconds);
  void step();
  /// Takes the last step back, and pauses. False: there is none that is remembered.
  bool back();
  void restart();

  /// The size of the picture, and how much of it at the left the panel covers, px.
  void resize(int width, int height, double panel_width);
  void home();
  void zoom(Vec2d pixel, double factor);
  void pan(Vec2d pixels);

  const std::vector<Series>& series() const { return series_; }
  std::size_t remembered() const { return history_.size(); }

  bool strict = false;  ///< what goes wrong is thrown, not said
  bool paused = false, slow = false, panel = true, sleep_shows = true;
  DrawOptions options{};
  Theme theme{};
  Camera camera{};
  std::string message{};  ///< the last thing to tell the player

  static constexpr double kSlow = 0.1;

 private:
  void remember();  // a new state
  void sample();
  template <class Act>
  void guarded(Act&& act);

  std::vector<Item> items_;
  std::size_t place_ = 0;
  Show show_;
  History history_;
  std::vector<Series> series_;
  bool pressed_ = false;
  bool at_home_ = true;  // the camera is where `home` put it
  int width_ = 1, height_ = 1;
  double panel_width_ = 0;
};

}  // namespace plumb::window
