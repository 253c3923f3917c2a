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
  double seconds_a_run = 300;  ///< then a run is stopped
  bool measure_cost = true;
  CostBudget cost{};
};

/// Where a comparison is.
struct Progress {
  std::size_t done = 0, total = 0;  ///< runs
  std::string what;                 ///< "pendulum_chain[20] on box2d"
};

struct CompareEvents {
  std::function<void(std::span<const Result>)> finished{};  ///< called once an instance, with all its results
  std::function<void(const Progress&)> progress{};
};

struct Comparison {
  std::vector<Result> results;
  bool interrupted = false;

  bool as_expected() const;
};

/// Runs every engine on every instance, each run in a process of its own; measures what a step costs with the
/// engines taking turns; holds the engines against each other; judges. An interrupt ends it early; what is
/// finished is in the results.
Comparison compare(const CompareOptions& options, const CompareEvents& events = {});

/// All engines' runs of one instance: the part of `compare` that shares one truth.
std::vector<Result> compare_on(const scenarios::Instance& instance, const CompareOptions& options,
                               const std::function<void(const reference::Backend&)>& starting = {});

/// Whether the settings are those that known limits are declared for.
bool is_default(const reference::StepSettings& settings);

}  // namespace plumb::harness
