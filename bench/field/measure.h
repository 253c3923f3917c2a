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
  std::optional<int> steps;           ///< instead of the scene's
  bool quick = false;                 ///< small scenes, few steps
  std::optional<bool> continuous;     ///< instead of the scene's
  double limit = 600;                 ///< s of an engine's own time; longer runs are aborted
  clockid_t clock = CLOCK_MONOTONIC;  ///< clock that measures the times
  WorldSettings settings;
};

/// Progress of the measurements.
struct Progress {
  int done = 0, total = 0;
  std::string what;
};

/// Results of all repetitions of one scene on one engine.
struct Measurement {
  const Scene* scene = nullptr;
  const Engine* engine = nullptr;
  std::string failure;  ///< why there are no figures; empty if there are
  Settings settings;
  Counts asked;    ///< bodies, shapes and joints in the scene at its end
  Counts counted;  ///< the engine's own counts at its end
  int steps = 0;
  bool continuous = true;
  std::vector<double> step_seconds;  ///< one per repetition: mean time of a step
  std::vector<double> cpu_share;     ///< one per repetition: processor time over wall time; below 1 with one
                                     ///< thread if other programs interfered
  Quality quality;                   ///< at the end; depths and joints over ten samples of the run
  Speed speed;                       ///< in one further step
  std::optional<double> height;      ///< smallest ratio of the height of a top to its initial height
  int escaped = 0;                   ///< bodies outside the scene's region
  double bytes_a_body = 0;        ///< bytes allocated since the world was empty, per body; 0 if not counted
  double allocations_a_step = 0;  ///< over the second half of the steps
  StageTimes stages;              ///< mean wall time of each stage of a step, ns; if asked for
};

/// Runs every scene on every engine `repeat` times, each time in a new world and a process of its own. Within
/// a scene the engines take turns, and each repetition starts with another one, so that disturbances of the
/// machine affect all alike. The first repetition also measures the quality, outside the measured time.
/// `progress` is called before each run, `done` after each scene; `interrupted` ends everything between two
/// runs. A non-finite state, an exception or crash of an engine and a run beyond the limit become a
/// `failure`. Call without threads running.
void measure(const Plan& plan, const std::function<void(const Progress&)>& progress,
             const std::function<void(std::vector<Measurement>&)>& done,
             const std::function<bool()>& interrupted);

/// Returns the median of `values`, or 0 if there are none.
double median(std::vector<double> values);

}  // namespace plumb::field
