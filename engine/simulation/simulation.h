#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/owned_pointer.h"
#include "engine/driver/accuracy.h"
#include "engine/driver/driver.h"
#include "engine/driver/plan.h"
#include "engine/scene/scene.h"

namespace plumb {

/// A compiled scene that can be stepped. Made by `compile`; movable, not copyable (use `save` and `restore`).
class Simulation {
 public:
  /// Advances by dt (Realtime) or max_dt (Precise), `count` times. Throws Error (Value) for a negative count.
  void step(int count = 1);

  double time() const;  ///< s since the start
  std::size_t body_count() const;
  BodyState state(std::size_t body) const;
  void read(std::span<BodyState> out) const;  ///< `out` has `body_count()` elements, in the scene's order
  void set_state(std::size_t body, const BodyState& state);  ///< Error (Value) beyond 1e100

  /// Returns the forces of joints and persistent contacts at `time`, for Precise; throws `Error`
  /// (Unsupported) for Realtime, which has only impulses. Before the first step, and after `set_state`, they
  /// are the forces with which the next step begins, after the impacts there; throws `Error` (Run) if it
  /// cannot begin. If joints are redundant, the first ones carry the whole load: one of many solutions.
  Reactions forces() const;

  /// Returns d state / d parameter at `time`, by body of the scene, for the parameter of this index in
  /// `CompileOptions::parameters`: each member is the derivative of that member of the body's state, in its
  /// unit over the parameter's (m/kg for a position by a mass). The derivative is at a fixed time and
  /// includes impacts and changes of contacts; its relative error is about the tolerance, 1e-9 at best.
  /// Throws `NotDifferentiable` (driver/sensitivity.h) after an event at which the state has no derivative,
  /// and `Error` (Value) for an invalid index. docs/precise.md says when derivatives do not exist.
  std::vector<BodyState> sensitivities(std::size_t parameter) const;

  /// Returns the 64-bit FNV-1a over the bits of every body's state and the time: equal on every platform for
  /// the same run.
  std::uint64_t hash() const;

  std::vector<std::byte> save() const;
  /// Throws `Error` (Value) when `snapshot` is not of this scene and accuracy, and then changes nothing.
  void restore(std::span<const std::byte> snapshot);

  const Plan& plan() const;
  void profile(bool on);
  Statistics statistics() const;
  /// With `OnViolation::Report`: returns the first violation of a monitored bound, or null. Valid until the
  /// next call of `step`, `set_state` or `restore`.
  const Error* violation() const;

 private:
  friend Simulation compile(const Scene&, const Accuracy&, CompileOptions);
  Simulation(OwnedPointer<Driver> driver, std::size_t body_count, std::uint64_t identity);

  OwnedPointer<Driver> driver_;
  std::size_t body_count_;
  std::uint64_t identity_;  ///< of scene and accuracy, stamped on snapshots
  bool abandoned_ = false;  ///< a step failed before its end
};

/// Validates `scene` and `accuracy`, derives the plan and allocates what it needs. Throws `Error`.
Simulation compile(const Scene& scene, const Accuracy& accuracy = Realtime{}, CompileOptions options = {});

/// Returns an empty string, or the reason why `accuracy` cannot run `scene` (a valid one).
std::string unsupported(const Scene& scene, const Accuracy& accuracy);

}  // namespace plumb
