#pragma once

#include <string>
#include <vector>

#include "demos/window/script.h"

namespace plumb::window {

/// How to show things.
struct Options {
  int width = 1280, height = 800;  ///< px
  double seconds = -1;             ///< of the show; negative: until the player has had enough
  std::string screenshot{};        ///< the last frame goes into this file
  int colours = 0;                 ///< of pictures, at most; 0: as many as there are
  std::vector<Deed> script{};
  int measured_frames = 0;  ///< as many frames as fast as they go, and how long they took
};

/// Shows the player in a window until it is closed. Throws Error (Io) where there is no display.
void run_in_window(Player& player, const Options& options);

/// Shows it to nobody, with 60 frames a second of the show's own time: the same calls give the same pictures.
/// Whatever goes wrong is thrown.
void run_headless(Player& player, const Options& options);

/// The figures of the demo, its time and its hash, a line each.
std::string report(const Player& player);

}  // namespace plumb::window
