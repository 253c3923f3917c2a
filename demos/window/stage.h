#pragma once

#include <string>
#include <vector>

#include "demos/window/run.h"
#include "demos/window/ui.h"

namespace plumb::window {

/// What windows and headless runs share: script, pictures and the measuring of frames.
class Stage {
 public:
  Stage(Player& player, const Options& options);

  /// Does what the script says until `time`. True: it says to quit.
  bool follow_script(double time);
  /// Writes the canvas into `file`, or into a file of a new name.
  void take_picture(const std::string& file = "");
  /// Carries a command out that the player leaves to us. True: to quit.
  bool carry_out(std::optional<Command> command);
  void frame(const PanelInput& input) { ui.frame(player_, input, canvas); }

  Canvas canvas;
  Ui ui;

 private:
  Player& player_;
  const Options& options_;
  std::size_t next_deed_ = 0;
  int pictures_ = 0;
};

/// How long the parts of frames took, ms.
class FrameTimes {
 public:
  struct Frame {
    double steps = 0, drawing = 0, showing = 0;
    double processor = 0;  // of all threads
  };
  void add(const Frame& frame) { frames_.push_back(frame); }
  std::size_t count() const { return frames_.size(); }
  /// Median and 99th percentile of each part, of the whole, and of the processor's time for it, which other
  /// programs do not lengthen.
  std::string report() const;

 private:
  std::vector<Frame> frames_;
};

/// ms, of a clock that only goes on; of the time that processors have spent on this program.
double now_ms();
double processor_ms();

}  // namespace plumb::window
