#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "demos/window/player.h"

namespace plumb::window {

/// An action of the player at a time, in s of the show (not of the demo, which may be paused).
struct Deed {
  enum class Kind { Press, Drag, Release, Hover, Key, Set, Show, Wheel, Picture, Scene };
  double time = 0;
  Kind kind = Kind::Key;
  Vec2d point{};     ///< m
  double turns = 0;  ///< of the wheel
  std::string text;  ///< the key, "NAME=VALUE", the kind of drawing, or the file
};

/// Parses lines "TIME press X Y", "drag X Y", "release X Y", "hover X Y", "key K", "set NAME=VALUE", "show
/// contacts", "wheel X Y TURNS", "picture FILE", "scene FILE"; empty ones and those that start with # are
/// skipped. Points are in m. Times do not decrease. Throws Error (Syntax) that names the line.
std::vector<Deed> parse_script(std::string_view text, const std::string& file);

/// Sets "NAME=VALUE": a number, on, off, or one of the control's choices. Throws Error (Name, Value).
void assign(demos::Demo& demo, std::string_view assignment);

/// Switches on a kind of drawing: "contacts", "velocities", "code", ... Throws Error (Name).
void show(Player& player, std::string_view name);

/// Returns the zoom factor of the wheel's turns.
double zoom_factor(double turns);

/// Executes an action. Returns commands that the caller must execute, such as pictures and scenes.
std::optional<Command> act(Player& player, const Deed& deed);

}  // namespace plumb::window
