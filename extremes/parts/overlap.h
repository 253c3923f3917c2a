#pragma once

#include <algorithm>
#include <cmath>

#include "extremes/parts/scenes.h"

namespace plumb::extremes {

/// Two free bodies of 1 m start with a penetration of `share` of their size, without gravity, for 5 s. They
/// must never exceed 10 m/s, and their penetration at the end is at most 1 %.
inline Trial overlapping(std::string name, const Geometry& geometry, double share) {
  constexpr double kSeconds = 5, kFastest = 10;
  Trial trial{.scene = {.name = std::move(name), .gravity = {}},
              .stretches = evenly(steps_for(kSeconds, kDt), 300)};
  trial.scene.bodies = {{.name = "left", .shapes = {{.geometry = geometry}}},
                        {.name = "right", .position = {1 - share, 0}, .shapes = {{.geometry = geometry}}}};
  trial.judge = [=](const Scene& scene) {
    Rule fast{
        .measure = "speed", .unit = "m/s", .bound = kFastest, .beyond = Verdict::Explodes, .sane = kFastest};
    fast.figure = [](double, std::span<const BodyState> states) {
      double out = 0;
      for (const BodyState& state : states)
        out = std::max(out, std::hypot(state.velocity.x, state.velocity.y));
      return out;
    };
    Rule deep = deepest_overlap(scene, 0.01);
    deep.measure = "overlap at the end";
    deep.figure = [figure = deep.figure](double t, std::span<const BodyState> states) {
      return t < kSeconds - kDt / 2 ? 0 : figure(t, states);
    };
    return judge_by({fast, deep});
  };
  return trial;
}

}  // namespace plumb::extremes
