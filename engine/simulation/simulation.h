#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/simulation/accuracy.h"
#include "engine/simulation/driver.h"
#include "engine/simulation/plan.h"

namespace plumb {

/// A compiled scene that moves. Made by `compile`; movable, not copyable (use `save` and `restore`).
class Simulation {
 public:
  /// Advances by dt (Realtime) or max_dt (Precise), `count` times. Throws Error (Value) for a negative count.
  void step(int count = 1);

  double time() const;  ///< s since the start
  std::size_t body_count() const;
  BodyState state(std::size_t body) const;
  void read(std::span<BodyState> out) const;  ///< `out` has `body_count()` elements, in the scene's order
  void set_state(std::size_t body, const BodyState& state);  ///< Error (Value) beyond 1e100

  /// The forces of joints and lasting contacts at `time`, of Precise; throws `Error` (Unsupported) where the
  /// accuracy is Realtime, which has impulses alone. Contacts have some from the first step on. Of joints
  /// that repeat what others hold, one of many answers: the first carry all.
  Reactions forces() const;

  /// 64-bit FNV-1a over the bits of every body's state and the time: equal on every platform for the same
  /// run.
  std::uint64_t hash() const;

  std::vector<std::byte> save() const;
  /// Throws `Error` (Value) when `snapshot` is not of this scene and accuracy, and changes nothing.
  void restore(std::span<const std::byte> snapshot);

  const Plan& plan() const;
  void profile(bool on);
  Statistics statistics() const;
  /// With `OnDoubt::Report`: the first thing that a step did not keep as promised, or null. Until the next
  /// call of `step`, `set_state` or `restore`.
  const Error* doubt() const;

 private:
  friend Simulation compile(const Scene&, const Accuracy&, struct CompileOptions);
  Simulation(std::unique_ptr<Driver> driver, std::size_t body_count, std::uint64_t identity);

  std::unique_ptr<Driver> driver_;
  std::size_t body_count_;
  std::uint64_t identity_;  ///< of scene and accuracy, stamped on snapshots
  bool abandoned_ = false;  ///< a step was not finished
};

struct CompileOptions {
  bool every_stage = false;  ///< run stages that the scene does not need as well; the bits stay the same
};

/// Validates `scene` and `accuracy`, derives the plan and allocates what it needs. Throws `Error`.
Simulation compile(const Scene& scene, const Accuracy& accuracy = Realtime{}, CompileOptions options = {});

/// Empty, or the reason why `accuracy` cannot run `scene` (a valid one).
std::string unsupported(const Scene& scene, const Accuracy& accuracy);

}  // namespace plumb
