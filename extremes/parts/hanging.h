#pragma once

#include "extremes/parts/scenes.h"

namespace plumb::extremes {

/// A chain, however it moves, of `length`, m, that turns over `energy`, J: its joints' gaps stay below 1 % of
/// its length together, its energy within 5 %.
inline std::unique_ptr<Judge> closed_and_lossless(const Scene& scene, double length, double energy) {
  return judge_by({sum_of_gaps(scene, length / 100, 10 * length), energy_gained(scene, energy, 0.05),
                   energy_lost(scene, energy, 0.05)});
}

/// A chain that hangs at rest: its joints' gaps stay below 1 % of its length together, and it stays.
inline Trial hanging(Scene scene, double length, double seconds) {
  Trial trial{.scene = std::move(scene), .stretches = evenly(steps_for(seconds, kDt), 100)};
  trial.exact = at_rest(trial.scene);
  trial.judge = [length](const Scene& of) {
    return judge_by(
        {sum_of_gaps(of, length / 100, 10 * length), farthest_from_start(of, length / 100, 10 * length)});
  };
  return trial;
}

}  // namespace plumb::extremes
