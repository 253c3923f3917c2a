#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <stdexcept>
#include <vector>

#include "engine/scene/scene.h"
#include "reference/backend.h"

namespace plumb::course {

/// Trace of an engine's run of a scene: the states at the start and after every sample.
struct Trace {
  std::vector<double> times;  ///< s
  std::vector<std::vector<BodyState>> states;

  const BodyState& first(std::size_t body) const { return states.front()[body]; }
  const BodyState& last(std::size_t body) const { return states.back()[body]; }
  double duration() const { return times.back(); }

  /// Returns true if the body's final position equals its initial position.
  bool still(std::size_t body) const { return last(body).position == first(body).position; }
};

/// Returns the largest distance, in m, by which a step of `dt` moves a body beyond the positions that
/// velocities between those before and after the step can reach. It is 0 for a bounce within a step. For a
/// correction of an overlap, it is the corrected fraction of the overlap.
double farthest_push(const Trace& trace, double dt);

/// Returns true if a step that changes no velocity moves bodies apart by more than their overlap without that
/// step. `gap` returns the distance of two surfaces, m, negative in an overlap.
bool pushed_too_far(const Trace& trace, double dt,
                    const std::function<double(const std::vector<BodyState>&)>& gap);

/// A scene that a check has run, and its result.
struct Recorded {
  Scene scene;
  Trace trace;
  double dt = 0;  ///< s, between the states of the trace
};

/// Thrown if the engine does not support the scene; `what()` is the reason.
class NotYet : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs scenes on an engine and knows how its method steps through time.
class Lab {
 public:
  /// Called with each state of a run as it is computed: the run's number, the state's number, and the state.
  /// It may throw to end the run.
  using Watcher = std::function<void(std::size_t, std::size_t, std::span<const BodyState>)>;

  /// Appends every run to `runs`, if given.
  Lab(const reference::Backend& engine, const reference::StepSettings& settings,
      std::vector<Recorded>* runs = nullptr, Watcher watcher = {});

  /// Refuses from now on what another lab's engine refuses, too, so that both make the same runs. The other
  /// lab must outlive this one.
  void refuse_as(const Lab& other) { refuses_as_ = &other.engine_; }

  /// Steps `scene` for as many whole steps as fit into `duration`, in s, with a sample after each. A step is
  /// dt / `finer`. Throws `NotYet`, or `Error` if the engine fails.
  Trace run(const Scene& scene, double duration, int finer = 1) const;

  /// Does the same with a single sample, after all steps. The run is not kept for comparisons.
  Trace run_to_end(const Scene& scene, double duration) const;

  /// Returns settings with which another engine takes steps and substeps of equal length.
  reference::StepSettings plain_settings() const;

  /// Returns false for engines with a tolerance: they refuse joints with an initial gap, and have no gaps to
  /// correct.
  bool corrects_positions() const { return method_.scheme != reference::Scheme::Adaptive; }

  double dt() const { return settings_.dt; }          ///< s
  double substep() const { return method_.substep; }  ///< s; 0 if the method adapts its own
  reference::Scheme scheme() const { return method_.scheme; }
  bool first_order() const { return method_.order == 1; }

  /// Returns the bound of rounding errors in a sum of the size of `scale` over `time` s: four roundings a
  /// step, each of half an epsilon. For adaptive methods adds 1e-6 `scale`.
  double rounding(double scale, double time) const;

  /// Returns the bound of the method's relative error for a motion of angular frequency or decay rate `rate`,
  /// 1/s: (rate h)^order / 2, at least `floor`.
  double method_error(double rate, double floor) const;

  /// Returns the fraction of a spin of `w` rad/s that a first-order method keeps over `time` s. A joint that
  /// corrects velocities at the end of each tangent step removes (w h)^2/2 a step, so dw/dt = -w^3 h/2.
  /// Returns 1 for other orders.
  double turn_kept(double w, double time) const;

  /// Returns the fraction of a spin of `w` rad/s that a first-order method keeps over `time` s if a step
  /// moves joined points back together and takes displacement/h for their velocities. The next displacement
  /// then starts along the last chord instead of the tangent. This removes (w h)^2 of w in each step, so
  /// dw/dt = -w^3 h. Returns 1 for other orders.
  double spin_kept_by_positions(double w, double time) const;

  /// Returns the factor on joint gaps relative to dt = 1/60 s, at least 1. A step along the tangent leaves a
  /// circle by the fraction (w dt)^2/2 of its radius.
  double coarseness() const;

  /// Returns the displacement in `time` s from velocity `v` under acceleration `a`, as the declared method
  /// computes it. The two Euler methods are off by a h t/2, with opposite signs; the others are exact.
  double way(double v, double a, double time) const;

 private:
  const reference::Backend& engine_;
  const reference::Backend* refuses_as_ = nullptr;
  reference::StepSettings settings_;
  reference::Method method_;
  std::vector<Recorded>* runs_;
  Watcher watcher_;
};

}  // namespace plumb::course
