#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/field/engines.h"
#include "bench/field/quality.h"
#include "bench/field/scene.h"

namespace plumb::field {

struct Plan {
  std::vector<const Scene*> scenes;
  std::vector<const Engine*> engines;
  int repeat = 3;
  std::optional<int> steps;           ///< measured steps, in place of the scene's
  bool quick = false;                 ///< small scenes, few steps
  std::optional<bool> continuous;     ///< in place of the scene's
  double limit = 600;                 ///< s of an engine's own time, after which a run is given up
  clockid_t clock = CLOCK_MONOTONIC;  ///< that times are taken by
  WorldSettings settings;
};

/// How far a run is, for whoever waits.
struct Progress {
  int done = 0, total = 0;
  std::string what;
};

/// What repetitions of one scene on one engine gave.
struct Measurement {
  const Scene* scene = nullptr;
  const Engine* engine = nullptr;
  std::string failure;  ///< why there are no figures; empty when there are
  Settings settings;
  Counts asked;    ///< what the scene holds at its end
  Counts counted;  ///< what the engine says that it holds at its end
  int steps = 0;
  bool continuous = true;
  std::vector<double> step_seconds;  ///< a repetition each: mean time of a step
  std::vector<double> cpu_share;     ///< a repetition each: time of the processors over time; below 1 with
                                     ///< one thread others were in the way
  Quality quality;                   ///< at the end; depths and joints over ten samples of the run
  Speed speed;                       ///< in one more step
  std::optional<double> height;      ///< least height of a top over its height at the start
  int escaped = 0;                   ///< bodies outside the scene's region
  double bytes_a_body = 0;           ///< allocated since the world was empty, over bodies; 0 when not counted
  double allocations_a_step = 0;     ///< over the second half of the steps
};

/// Runs every scene on every engine `repeat` times, each time in a new world and a process of its own. Within
/// a scene the engines take turns, and each repetition starts with another one, so that what disturbs the
/// machine disturbs them alike. The first repetition measures the quality as well, outside the clock.
/// `progress` is called before each run, `done` after each scene; `interrupted` ends the whole between two
/// runs. A state that is not finite, an engine that throws or dies and a run beyond the limit become a
/// `failure`. Call without threads running.
void measure(const Plan& plan, const std::function<void(const Progress&)>& progress,
             const std::function<void(std::vector<Measurement>&)>& done,
             const std::function<bool()>& interrupted);

/// The middle of sorted `values`, or the mean of the two in the middle.
double median(std::vector<double> values);

}  // namespace plumb::field
