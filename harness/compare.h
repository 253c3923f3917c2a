#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/cost.h"
#include "harness/result.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

struct CompareOptions {
  std::vector<scenarios::Instance> instances;
  std::vector<const reference::Backend*> engines;
  reference::StepSettings settings{};
  double seconds_a_run = 300;  ///< wall time after which a run is stopped
  bool measure_cost = true;
  CostBudget cost{};
};

/// Progress of a comparison.
struct Progress {
  std::size_t done = 0, total = 0;  ///< runs
  std::string what;                 ///< "pendulum_chain[20] on box2d"
};

struct CompareEvents {
  std::function<void(std::span<const Result>)> finished{};  ///< called once per instance with all results
  std::function<void(const Progress&)> progress{};
};

struct Comparison {
  std::vector<Result> results;
  bool interrupted = false;

  bool as_expected() const;
};

/// Runs every engine on every instance, each run in a process of its own. Measures the cost of a step with
/// the engines taking turns, compares the engines with each other, and judges. An interrupt ends it early;
/// the results then contain all finished instances.
Comparison compare(const CompareOptions& options, const CompareEvents& events = {});

/// Runs all engines on one instance: the part of `compare` that shares one truth.
std::vector<Result> compare_on(const scenarios::Instance& instance, const CompareOptions& options,
                               const std::function<void(const reference::Backend&)>& starting = {});

/// Returns true if known limits are declared for these settings.
bool is_default(const reference::StepSettings& settings);

}  // namespace plumb::harness
