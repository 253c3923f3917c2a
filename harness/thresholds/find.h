#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "harness/thresholds/finding.h"
#include "harness/thresholds/threshold.h"
#include "reference/backend.h"

namespace plumb::harness::thresholds {

/// A critical value to be found.
struct Request {
  const Threshold* threshold = nullptr;
  const reference::Backend* backend = nullptr;
  std::string setting = "default";
  reference::StepSettings settings{.dt = kStep};
};

struct FindOptions {
  int digits = 3;             ///< of the critical value, 1..4
  int jobs = 1;               ///< searches at a time
  double seconds_a_run = 30;  ///< time limit, after which a run counts as broken
};

/// Finds `request`'s value, each run in a process of its own. Exceptions of the engine become the finding's
/// outcome.
Finding find_one(const Request& request, const FindOptions& options);

/// Finds the values of all requests, `options.jobs` searches at a time. Calls `done` as they end, with
/// nullopt for those that an interrupt has ended.
void find_all(std::span<const Request> requests, const FindOptions& options,
              const std::function<void(std::size_t, const std::optional<Finding>&)>& done);

}  // namespace plumb::harness::thresholds
