#pragma once

#include <memory>

#include "extremes/parts/scenes.h"

namespace plumb::extremes {

/// Judges a moving chain of `length`, m. The sum of its joints' gaps must stay below 1 % of `length`, and its
/// energy error below 5 % of `energy`, J.
inline std::unique_ptr<Judge> closed_and_lossless(const Scene& scene, double length, double energy) {
  return judge_by({sum_of_gaps(scene, length / 100, 10 * length), energy_gained(scene, energy, 0.05),
                   energy_lost(scene, energy, 0.05)});
}

/// A chain that hangs at rest: the sum of its joints' gaps and each displacement stay below 1 % of its
/// length.
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
