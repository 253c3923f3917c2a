#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "harness/run.h"
#include "harness/sweep/own_limit.h"
#include "harness/sweep/space.h"

namespace plumb::harness::sweep {

/// References with which the runs of one instance are compared, created on first use: the scenario's truth,
/// shared by all engines, or each engine's own limit if the scenario has no truth.
class Cases {
 public:
  /// `seconds`: time limit of the last run for an engine's own limit.
  Cases(scenarios::Instance instance, Ladder ladder, double seconds);
  Cases(const Cases&) = delete;
  Cases& operator=(const Cases&) = delete;

  /// Returns true if there is an answer that no engine computed.
  bool has_truth() const { return has_truth_; }

  /// Returns the reference for a run with steps of `dt`. Throws `Error` (Run) if the engine's motion has no
  /// limit.
  const Case& at(const reference::Backend& backend, double dt) {
    return sampled(backend, sample_interval(dt));
  }
  /// Returns the reference with states `sample` s apart.
  const Case& sampled(const reference::Backend& backend, double sample);

  /// Sets the settings of the run that is the engine's own limit, instead of searching for them.
  void take_limit(const reference::Backend& backend, const reference::StepSettings& settings);

  /// Returns the engine's own limit; only used if `has_truth` is false.
  const OwnLimit& limit(const reference::Backend& backend);

 private:
  struct Own {
    std::shared_ptr<const OwnLimit> limit;
    scenarios::Scenario scenario;
  };
  Own& own(const reference::Backend& backend);

  scenarios::Instance instance_;
  Ladder ladder_;
  double seconds_;
  bool has_truth_;
  std::map<std::string, Own> own_;  // by engine
  std::map<std::string, reference::StepSettings> taken_;
  std::map<std::pair<std::string, double>, std::unique_ptr<Case>> cases_;
};

}  // namespace plumb::harness::sweep
