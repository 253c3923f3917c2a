#pragma once

#include <optional>
#include <span>
#include <vector>

#include "harness/bounds.h"
#include "harness/energy.h"
#include "harness/joint_gap.h"
#include "harness/penetration.h"
#include "harness/result.h"
#include "harness/run.h"
#include "harness/track.h"

namespace plumb::harness {

/// Measures a run sample by sample: metrics, checks, and the track for comparing engines. Keeps no
/// trajectory, so its memory does not grow with the run.
class Observer {
 public:
  Observer(const Case& scene_case, const reference::Method& method, const reference::StepSettings& settings,
           Track* track);

  void add(int sample, std::span<const BodyState> states);

  bool diverged() const { return !why_diverged_.empty(); }
  /// Writes metrics and checks and, if the run diverged, status and reason.
  void finish(Result& result) const;

 private:
  struct Errors {
    double position = 0, angle = 0, velocity = 0, angular_velocity = 0;
  };

  void watch_for_divergence(int sample, std::span<const BodyState> states);
  void against_truth(int sample, std::span<const BodyState> states);
  void against_discrete(int sample, std::span<const BodyState> states);
  void invariants(int sample, std::span<const BodyState> states);
  void follow(int sample, std::span<const BodyState> states);
  void against_expected(int sample, std::span<const BodyState> states);
  void expect_at(std::size_t index, double time, std::span<const BodyState> states);
  void finish_expected(Result& result) const;
  double measured(scenarios::Expectation::Law law) const;
  bool near_impact(double time) const;

  const Case& case_;
  reference::Method method_;
  ConservationScale scale_;
  Tolerances tolerances_;
  DriftMeter drifts_;
  JointGaps joints_;
  PenetrationMeter penetration_;
  Track* track_;
  std::string why_diverged_;
  Metrics metrics_;
  WorstRatio position_, angle_, velocity_, angular_velocity_;
  WorstRatio discrete_position_, discrete_angle_, discrete_velocity_, discrete_angular_velocity_;
  WorstRatio energy_, momentum_, angular_momentum_, gap_, depth_, finite_;
  std::vector<BodyState> discrete_;
  bool discrete_known_ = true;
  bool derived_;                         // checks the bounds that follow from the method
  std::vector<WorstRatio> expected_;     // by expectation
  std::vector<std::size_t> times_done_;  // by expectation
  Mechanics largest_;                    // largest values of the run so far, if expectations need them
  std::vector<BodyState> before_;        // states of the previous sample, if expectations need them
};

}  // namespace plumb::harness
