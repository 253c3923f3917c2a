#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/driver/accuracy.h"
#include "engine/driver/driver.h"
#include "engine/integrate/compensated.h"
#include "engine/precise/dynamics/ballistic_motion.h"
#include "engine/precise/dynamics/initial_joint_errors.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/dynamics/scene_partition.h"
#include "engine/precise/events/contacts.h"
#include "engine/precise/integration/integrator.h"
#include "engine/precise/invariants.h"
#include "engine/precise/plan.h"
#include "engine/precise/sensitivity/sensitivities.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// The driver that `make_precise_driver` returns.
class PreciseDriver final : public Driver {
 public:
  /// `variations`: one for each parameter by which states are derived, if any.
  PreciseDriver(const Scene& scene, const Precise& precise, const CompileOptions& options,
                std::vector<Variation> variations = {});

  void step() override;
  double time() const override { return time_; }
  void read(std::span<BodyState> out) const override;
  void write(std::size_t body, const BodyState& state) override;
  std::vector<std::byte> save() const override;
  void restore(std::span<const std::byte> snapshot) override;
  Reactions reactions() override;
  std::vector<BodyState> sensitivities(std::size_t parameter) override;
  const Plan& plan() const override { return plan_; }
  void profile(bool on) override;
  Statistics statistics() const override;

 private:
  /// Returns true if the motion has crossed a singularity that the sensitivities have not handled yet.
  bool has_new_singularity() const { return integrator_.singularity_steps() != handled_singularities_; }
  bool active(StageIndex stage) const { return plan_.stages[stage].active; }

  // The parts of a step, in this order.
  void close_joints();
  void advance(double end);
  void prepare_step();
  double limit_of_step(double end) const;
  void switch_forces();
  void resolve_event();
  void advance_sensitivities();

  // Helpers of these parts.
  Reactions reactions_of_next_step();
  void report_redundant_joints();
  void check_initial_gaps() const;
  std::size_t slot_of(std::size_t body) const;
  void load(std::span<const std::byte> snapshot);
  void check_finite();
  void report_cost();
  [[noreturn]] void fail(const std::string& subject, const std::string& field, const std::string& value,
                         const std::string& problem) const;

  const double max_dt_, overlap_tolerance_;  // s; fraction of the scene's length that shapes may overlap by
                                             // at the start
  ScenePartition partition_;
  Plan plan_;
  BallisticMotion ballistic_;
  EquationsOfMotion equations_;
  mutable EventFreeIntegrator integrator_;  // mutable: computes its polynomial when it is read
  mutable Compensated sample_;              // of the integrated bodies at sampled_, if within the last step
  mutable double sampled_ = -1;             // s
  Contacts contacts_;
  Invariants invariants_;
  std::unique_ptr<Sensitivities> sensitivities_;  // null without parameters
  std::int64_t handled_singularities_ = 0;        // by the sensitivities
  std::vector<std::string> names_;
  std::vector<char> is_static_, locked_;  // by body: static; without rotation

  double time_ = 0;  // s, of the states read: within the last step of the motion, or at its end
  std::int64_t grid_steps_ = 0;
  bool joints_closed_ = false;
  bool written_ = false;            // bodies were changed from outside
  InitialJointError open_joint_{};  // the joint with the largest gap at the start; gap 0: none is open
  Statistics statistics_{};
  int steps_in_step_ = 0;
  double last_event_ = 0, last_flight_ = 0;  // s: time of the last event, and the flight before it
  std::int64_t impacts_before_ = 0;          // at the start of the step
  bool profiling_ = false;
  std::array<double, kStageCount> cost_{};
};

}  // namespace plumb::precise
