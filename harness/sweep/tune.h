#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/metrics.h"
#include "harness/result.h"
#include "harness/style.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness::sweep {

/// Goal of a search for settings: least cost for a given error, or least error for a given cost.
struct TuneOptions {
  scenarios::Instance instance;
  std::string run_as{};  ///< the argument of `plumb run`; if empty, its label
  std::vector<const reference::Backend*> engines;
  const MetricField* metric = nullptr;
  std::optional<double> tolerance{};  ///< in the metric's unit
  std::optional<double> budget_ns{};  ///< for one step of the game
  double step = 1.0 / 60;             ///< s, of the game: dt is this step or a repeated half of it
  double seconds = 45;                ///< s, for the search; measuring costs comes on top
  double seconds_a_run = 10;
  int jobs = 1;
  int repetitions = 9;
};

/// The best settings of one engine.
struct TuneAnswer {
  std::string engine;
  bool found = false;
  std::string problem;     ///< reason if there is no answer
  Result row;              ///< the run of the settings, with measured cost; without an answer, the nearest
  double error = 0;        ///< of the metric; the larger if two runs differ
  double ns_a_step = 0;    ///< for one step of the game
  int tried = 0;           ///< number of settings that were run
  bool confirmed = false;  ///< true if the repeated run had the same error to the bit
};

struct Tuned {
  bool has_truth = false;  ///< true if there is a truth; else each engine is compared with its own limit
  std::vector<TuneAnswer> answers;  ///< best first, then those without an answer
  bool interrupted = false;
};

/// Searches every engine's settings near the goal, then measures the costs of the best few of all engines in
/// turns. Repeats the run of each answer: it must meet the goal in both.
Tuned tune(const TuneOptions& options, const std::function<void(const std::string& what)>& progress = {});

std::string tune_text(const TuneOptions& options, const Tuned& tuned, const Style& style);
/// Returns one answer's engine, settings, calls per step of the game, error and cost, and the command.
std::string settings_json(const TuneOptions& options, const TuneAnswer& answer);
std::string tune_json(const TuneOptions& options, const Tuned& tuned);

}  // namespace plumb::harness::sweep
