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

/// What is asked of the settings: an error that must be reached as cheaply as possible, or a cost that must
/// be kept with as little error as possible. One of the two is given.
struct TuneOptions {
  scenarios::Instance instance;
  std::string run_as{};  ///< what `plumb run` takes for it; empty: its label
  std::vector<const reference::Backend*> engines;
  const MetricField* metric = nullptr;
  std::optional<double> tolerance{};  ///< in the metric's unit
  std::optional<double> budget_ns{};  ///< for one step of the game
  double step = 1.0 / 60;             ///< s, of the game: dt is this, or this halved some times
  double seconds = 45;                ///< for the search; measuring costs follows
  double seconds_a_run = 10;
  int jobs = 1;
  int repetitions = 9;
};

/// The best settings of one engine.
struct TuneAnswer {
  std::string engine;
  bool found = false;
  std::string problem;     ///< why there is none
  Result row;              ///< the run of the settings, its cost measured; where none is found, the nearest
  double error = 0;        ///< of the metric; of two runs that differ the larger
  double ns_a_step = 0;    ///< for one step of the game
  int tried = 0;           ///< settings that were run
  bool confirmed = false;  ///< run once more at the end, with the same error to the bit
};

struct Tuned {
  bool has_truth = false;           ///< else each engine is held against its own limit
  std::vector<TuneAnswer> answers;  ///< best first, then those without an answer
  bool interrupted = false;
};

/// Searches every engine's settings near where the wish is met, measures the costs of the best few of all
/// engines in turns, and runs each answer once more: what the second run misses is no answer.
Tuned tune(const TuneOptions& options, const std::function<void(const std::string& what)>& progress = {});

std::string tune_text(const TuneOptions& options, const Tuned& tuned, const Style& style);
/// Of one answer: engine, settings, how often a step of the game calls it, what it reaches, and the command.
std::string settings_json(const TuneOptions& options, const TuneAnswer& answer);
std::string tune_json(const TuneOptions& options, const Tuned& tuned);

}  // namespace plumb::harness::sweep
