#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "harness/thresholds/finding.h"
#include "harness/thresholds/threshold.h"
#include "reference/backend.h"

namespace plumb::harness::thresholds {

/// A critical value that is to be found.
struct Request {
  const Threshold* threshold = nullptr;
  const reference::Backend* backend = nullptr;
  std::string setting = "default";
  reference::StepSettings settings{.dt = kStep};
};

struct FindOptions {
  int digits = 3;             ///< of the critical value, 1..4
  int jobs = 1;               ///< searches at a time
  double seconds_a_run = 30;  ///< then a run counts as broken
};

/// Finds `request`'s value, each run in a process of its own. What an engine throws becomes the finding's
/// outcome.
Finding find_one(const Request& request, const FindOptions& options);

/// All of them, `options.jobs` searches at a time. `done` is called as they end, with nothing for those that
/// an interrupt has ended.
void find_all(std::span<const Request> requests, const FindOptions& options,
              const std::function<void(std::size_t, const std::optional<Finding>&)>& done);

}  // namespace plumb::harness::thresholds
