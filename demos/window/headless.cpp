#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "demos/window/run.h"
#include "demos/window/stage.h"

namespace plumb::window {
namespace {

constexpr double kFrame = 1.0 / 60;  // s

void measure(Player& player, Stage& stage, int frames) {
  FrameTimes times;
  for (int i = 0; i < frames; ++i) {
    const double start = now_ms(), processor = processor_ms();
    player.advance(kFrame);
    const double stepped = now_ms();
    stage.frame({});
    times.add({stepped - start, now_ms() - stepped, 0, processor_ms() - processor});
  }
  fmt::print("{}", times.report());
}

}  // namespace

void run_headless(Player& player, const Options& options) {
  player.strict = true;
  Stage stage(player, options);
  const long frames = std::lround(std::max(options.seconds, 0.0) / kFrame);
  bool done = stage.follow_script(0);
  for (long i = 0; i < frames && !done; ++i) {
    player.advance(kFrame);
    done = stage.follow_script(static_cast<double>(i + 1) * kFrame);
  }
  if (options.measured_frames > 0) measure(player, stage, options.measured_frames);
  if (!options.screenshot.empty()) {
    // The panel lays out its scroll bars in a second frame.
    stage.frame({});
    stage.frame({});
    stage.take_picture(options.screenshot);
  }
}

}  // namespace plumb::window
