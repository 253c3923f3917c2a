#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/driver/accuracy.h"
#include "engine/driver/driver.h"
#include "engine/world/add_scene.h"
#include "engine/world/invariant_monitor.h"
#include "engine/world/scene/scene_drives.h"
#include "engine/world/scene/scene_forces.h"
#include "engine/world/world.h"

namespace plumb {

/// A world with a scene's bodies, joints and force laws, advanced in fixed steps.
template <class Real>
class WorldDriver final : public Driver {
 public:
  /// The scene and the accuracy are valid and supported.
  WorldDriver(const Scene& scene, const Realtime& accuracy, bool every_stage);

  void step() override;
  double time() const override { return static_cast<double>(steps_) * accuracy_.dt; }
  void read(std::span<BodyState> out) const override;
  void write(std::size_t body, const BodyState& state) override;
  std::vector<std::byte> save() const override;
  void restore(std::span<const std::byte> snapshot) override;
  const Plan& plan() const override { return plan_; }
  void profile(bool on) override;
  Statistics statistics() const override;
  void abandon_step() override { abandoned_ = true; }
  const Error* violation() const override { return violation_ ? &*violation_ : nullptr; }

 private:
  void advance();
  void apply_forces(double dt);
  void check();
  void handle_violation();
  void restore_start_states();
  void update_profile();

  Realtime accuracy_;
  Plan plan_;
  BasicWorld<Real> world_;
  SceneParts parts_;
  SceneForces<Real> forces_;
  SceneDrives<Real> drives_;
  std::vector<BodyState> start_states_;   // by body, at the start of the step
  std::vector<std::byte> undo_snapshot_;  // snapshot at that time, in case a violation undoes the step
  std::optional<InvariantMonitor<Real>> monitor_;
  std::optional<Error> step_violation_;  // in this step
  std::optional<Error> violation_;       // the first
  std::int64_t steps_ = 0;
  double force_time_ = 0;   // ns
  bool abandoned_ = false;  // memory ran out during a step: only `start_states_` is valid
  bool profiling_ = false;
};

/// Returns an empty string, or the reason why fixed steps cannot run `scene` (a valid one).
std::string realtime_unsupported(const Scene& scene, const Realtime& accuracy);

}  // namespace plumb
