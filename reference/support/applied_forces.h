#pragma once

#include <cstddef>
#include <vector>

#include "engine/forces/laws.h"
#include "engine/scene/scene.h"

namespace plumb::reference {

/// The scene's force laws for an engine that takes a force and a torque per step.
class AppliedForces {
 public:
  explicit AppliedForces(const Scene& scene);

  bool empty() const { return bodies_.empty(); }

  /// Reads the state of each body that laws act on and applies the sum of its wrenches, averaged over
  /// [start, end] for laws that depend on time.
  template <class StateOf, class Apply>
  void apply(double start, double end, StateOf&& state_of, Apply&& apply) {
    for (const std::size_t body : bodies_) place(body, state_of(body));
    laws_.add(start, end, poses_.data(), twists_.data(), wrenches_.data());
    for (const std::size_t body : bodies_) apply(body, wrenches_[body]);
  }

  /// Does the same for an engine that evaluates forces at each stage, `time`, of a step from `start` to
  /// `end`.
  template <class StateOf, class Apply>
  void apply_at(double time, double start, double end, StateOf&& state_of, Apply&& apply) {
    for (const std::size_t body : bodies_) place(body, state_of(body));
    laws_.add_at(time, start, end, poses_.data(), twists_.data(), wrenches_.data());
    for (const std::size_t body : bodies_) apply(body, wrenches_[body]);
  }

 private:
  void place(std::size_t body, const BodyState& state);

  Forces laws_;
  std::vector<std::size_t> bodies_;
  std::vector<Pose<double>> poses_;  // by body
  std::vector<Twist<double>> twists_;
  std::vector<Wrench<double>> wrenches_;
};

}  // namespace plumb::reference
