#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/check.h"
#include "harness/known_limits.h"
#include "harness/metrics.h"
#include "reference/backend.h"

namespace plumb::harness {

enum class Status {
  Ok,        ///< ran to its end
  Skipped,   ///< the engine cannot run this scene, or is not installed
  Failed,    ///< the engine reported an error
  Crashed,   ///< the engine's process died
  Timeout,   ///< the run exceeded its time limit
  Diverged,  ///< a state is non-finite, or farther from the truth than a thousand extents of the scene
};

std::string_view name_of(Status status);

/// Wall time, as the median of repetitions that took turns with the other engines' on the same scene.
struct Cost {
  double ns_per_step = 0;  ///< a step is one dt, with all its substeps; no sampling, no transport
  double ns_per_step_low = 0,
         ns_per_step_high = 0;  ///< the interquartile range of the repetitions
  double ns_per_simulated_second = 0;
  double setup_ns = 0;  ///< from the scene to the first step
  int repetitions = 0;
  int steps = 0;                           ///< steps per repetition, from the start of the run
  std::vector<double> each_ns_per_step{};  ///< of every repetition, in the order in which they were measured
};

/// One engine's run of one instance.
struct Result {
  std::string scenario, variant;
  int size = 1;
  std::string label;  ///< "elastic_collision/oblique", "pendulum_chain[20]"
  std::string engine, engine_version, precision;
  double dt = 0;           ///< s
  double sample = 0;       ///< s, interval between measured states: dt or a multiple of it
  double duration = 0;     ///< s
  std::string truth;       ///< source of the exact answer
  Metrics truth_within{};  ///< accuracy of a truth that is an engine's own limit; smaller errors are
                           ///< not known
  std::optional<reference::StepSettings> truth_asked{};  ///< settings of the run that is such a truth
  reference::StepSettings asked{};                       ///< requested settings, which reproduce the run
  reference::Settings settings;
  Status status = Status::Ok;
  std::string reason;  ///< why it is not ok
  Metrics metrics;
  std::optional<Cost> cost;
  std::string cost_reason{};  ///< why a cost that was to be measured is not known
  std::vector<Check> checks;
  std::vector<std::string> agrees_with, disagrees_with;  ///< other engines, within the sum of both bounds
  std::vector<std::string> unexpected;                   ///< reasons for which the run fails, as sentences
  std::string machine{};       ///< kind of machine that the cost was measured on; empty if unknown
  bool cost_left_out = false;  ///< removed, because the scene's other costs are of another kind of machine
  bool foreign_cost = false;   ///< the cost is that of another platform, never ranked with native ones
  std::string excused;         ///< reason why misses of this run are not failures; empty if they are

  bool ran() const { return status == Status::Ok || status == Status::Diverged; }
  const Check* find_check(std::string_view name) const;

  /// Returns true if the run ended and every check is within its bound; nullopt if it did not run.
  std::optional<bool> agrees_with_truth() const;
};

/// Lists the deviations of `result` from the declarations: checks missed without a declared limit, and a run
/// that failed, crashed or timed out. Also marks missed checks that are declared. If `defaults` says that the
/// run used the settings of the declarations, it also lists declared limits that are no longer missed.
void judge(Result& result, bool defaults, std::span<const KnownLimit> limits = known_limits());

/// Converts to one line of JSON, without and with the environment. `result_from_json` reads either.
std::string to_json(const Result& result);
std::string to_json_with_environment(const Result& result);
Result result_from_json(std::string_view text);

}  // namespace plumb::harness
