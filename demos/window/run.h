#pragma once

#include <string>
#include <vector>

#include "demos/window/script.h"

namespace plumb::window {

/// Options of a window or a headless run.
struct Options {
  int width = 1280, height = 800;  ///< px
  double seconds = -1;             ///< duration of the show; negative: until the player quits
  std::string screenshot{};        ///< file for the last frame
  int colours = 0;                 ///< largest number of colours in a picture; 0: unlimited
  std::vector<Deed> script{};
  int measured_frames = 0;  ///< number of frames to draw at full speed; reports their times
};

/// Shows the player in a window until it is closed. Throws Error (Io) if there is no display.
void run_in_window(Player& player, const Options& options);

/// Runs without a window, with 60 frames per second of the run's own time: the same calls give the same
/// pictures. Throws all errors.
void run_headless(Player& player, const Options& options);

/// Returns the demo's figures, its time and its hash, one per line.
std::string report(const Player& player);

}  // namespace plumb::window
