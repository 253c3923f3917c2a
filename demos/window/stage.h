#pragma once

#include <string>
#include <vector>

#include "demos/window/run.h"
#include "demos/window/ui.h"

namespace plumb::window {

/// Common parts of windows and headless runs: script, pictures and frame times.
class Stage {
 public:
  Stage(Player& player, const Options& options);

  /// Executes the script up to `time`. Returns true if it quits.
  bool follow_script(double time);
  /// Writes the canvas to `file`, or to a file with a new name.
  void take_picture(const std::string& file = "");
  /// Writes the demo's present state as a scene (JSON) to `file`, or to a file with a new name.
  void write_scene(const std::string& file = "");
  /// Executes a command that the player leaves to the caller. Returns true to quit.
  bool carry_out(std::optional<Command> command);
  void frame(const PanelInput& input) { ui.frame(player_, input, canvas); }

  Canvas canvas;
  Ui ui;

 private:
  Player& player_;
  const Options& options_;
  std::size_t next_deed_ = 0;
  int pictures_ = 0, scenes_ = 0;
};

/// Times of the parts of frames, ms.
class FrameTimes {
 public:
  struct Frame {
    double steps = 0, drawing = 0, showing = 0;
    double processor = 0;  // of all threads
  };
  void add(const Frame& frame) { frames_.push_back(frame); }
  std::size_t count() const { return frames_.size(); }
  /// Reports the median and 99th percentile of each part, of the whole, and of its processor time, which
  /// other programs do not lengthen.
  std::string report() const;

 private:
  std::vector<Frame> frames_;
};

/// Return a monotonic time, and the processor time of this program, ms.
double now_ms();
double processor_ms();

}  // namespace plumb::window
