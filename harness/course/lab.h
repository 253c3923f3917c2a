#pragma once

#include <stdexcept>
#include <vector>

#include "engine/scene/scene.h"
#include "reference/backend.h"

namespace plumb::course {

/// What an engine did with a scene: the states at the start and after every sample.
struct Trace {
  std::vector<double> times;  ///< s
  std::vector<std::vector<BodyState>> states;

  const BodyState& first(std::size_t body) const { return states.front()[body]; }
  const BodyState& last(std::size_t body) const { return states.back()[body]; }
  double duration() const { return times.back(); }

  /// Whether the body is where it was at the start, after all of it.
  bool still(std::size_t body) const { return last(body).position == first(body).position; }
};

/// The engine does not do such scenes; `what()` is the reason.
class NotYet : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Where an engine is tried: runs scenes on it and knows how its method steps through time.
class Lab {
 public:
  Lab(const reference::Backend& engine, const reference::StepSettings& settings);

  /// Steps `scene` for as many whole steps as `duration`, in s, holds, with a sample each step. `finer` parts
  /// of dt make a step. Throws `NotYet`, or `Error` where the engine fails.
  Trace run(const Scene& scene, double duration, int finer = 1) const;

  double dt() const { return settings_.dt; }          ///< s
  double substep() const { return method_.substep; }  ///< s; 0 where the method adapts its own
  reference::Scheme scheme() const { return method_.scheme; }

  /// What rounding may do to a sum of the size of `scale` in `time` s: half a unit a step, with four
  /// operations a step.
  double rounding(double scale, double time) const;

  /// Bound of a first-order method's relative error at `rate` 1/s: rate h/2, of higher orders its power; and
  /// `floor` at least.
  double method_error(double rate, double floor) const;

  /// How much a first-order method slows a turn at `w` rad/s in `time` s: a joint that turns velocities at
  /// the end of each tangent step takes 1 - (w h)^2/2 a step, dw/dt = -w^3 h/2. 1 for methods of higher
  /// order.
  double turn_kept(double w, double time) const;

  /// How much wider joints may come apart than at 1/60 s: a step along the tangent leaves a circle by
  /// (w dt)^2/2 of its radius.
  double coarseness() const;

  /// The way in `time` s from velocity `v` under acceleration `a`, as the declared method computes it:
  /// Euler's two methods are off by a h t/2, to either side; the others are exact.
  double way(double v, double a, double time) const;

 private:
  const reference::Backend& engine_;
  reference::StepSettings settings_;
  reference::Method method_;
};

}  // namespace plumb::course
