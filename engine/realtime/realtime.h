#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/driver/driver.h"
#include "engine/forces/laws.h"
#include "engine/realtime/constants.h"
#include "engine/realtime/contact_finder.h"
#include "engine/realtime/contact_solver.h"
#include "engine/realtime/impact_stage.h"
#include "engine/realtime/joint_method.h"
#include "engine/realtime/stages.h"
#include "engine/realtime/watch.h"

namespace plumb {

/// Fixed steps: detect, then for each substep forces, impulses, motion. The integrators' arithmetic stands in
/// a file each: velocity_verlet.cpp, semi_implicit_euler.cpp, explicit_euler.cpp.
template <class Real>
class RealtimeDriver final : public Driver {
 public:
  /// The scene and the accuracy are valid and supported.
  RealtimeDriver(const Scene& scene, const Realtime& accuracy, bool every_stage);

  void step() override;
  double time() const override;
  void read(std::span<BodyState> out) const override;
  void write(std::size_t body, const BodyState& state) override;
  std::vector<std::byte> save() const override;
  void restore(std::span<const std::byte> snapshot) override;
  const Plan& plan() const override { return plan_; }
  void profile(bool on) override;
  Statistics statistics() const override { return statistics_; }
  void abandon_step() override;
  const Error* doubt() const override { return doubt_ ? &*doubt_ : nullptr; }

 private:
  using enum RealtimeStage;

  /// Runs one stage of the plan if it is active, by the clock when profiling is on.
  template <class Work>
  void stage(RealtimeStage which, Work&& work) {
    Stage& entry = plan_.stages[static_cast<std::size_t>(which)];
    if (!entry.active) return;
    if (!profiling_) return work();
    const auto start = std::chrono::steady_clock::now();
    work();
    entry.nanoseconds +=
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }

  // Integrators: one substep of length h from time t.
  void velocity_verlet(double t, Real h);
  void semi_implicit_euler(double t, Real h);
  void explicit_euler(double t, Real h);

  // Parts of the integrators.
  void plan_for_towers();
  void detect(Real dt);
  void evaluate_forces(double t0, double t1, const std::vector<Twist<Real>>& twists);
  void predict_velocities(Real duration);
  void kick(Real duration);
  void resolve_impacts(Real h);
  void hold(Real h);
  void relax(Real h);
  void push_out(Real h);
  void collide(Real h);
  void drift(Real h);
  void check();
  void watch();

  int sweeps_a_pass() const;
  int sweeps_for_loads() const;

  void set_motion(std::size_t body, const BodyState& state);
  void put_back_motion();
  void roll_back();
  std::string after_this_step() const;
  std::span<const SolidShape<Real>> shapes() const {
    return finder_ ? finder_->shapes() : std::span<const SolidShape<Real>>{};
  }
  bool contacts_active() const { return is_active(plan_, ContactHold); }
  bool joints_active() const { return is_active(plan_, JointHold); }

  Realtime accuracy_;
  Plan plan_;
  std::vector<std::string> names_;
  std::vector<char> dynamic_, fixed_rotation_;  // by body
  Bodies<Real> bodies_;
  Vec2<Real> gravity_;
  plumb::Forces<Real> forces_;
  std::vector<Wrench<Real>> wrenches_;
  std::vector<Twist<Real>> predicted_;
  ContactSolver<Real> contact_solver_;
  std::unique_ptr<ContactFinder<Real>> finder_;
  std::vector<Contact<Real>> contacts_;
  std::unique_ptr<ImpactStage<Real>> impacts_;
  std::unique_ptr<JointMethod<Real>> joints_;
  std::vector<Vec2<Real>> remainder_;  // m, what rounding left out of the positions
  std::vector<Vec2<Real>> last_remainder_;
  std::vector<Pose<Real>> last_pose_;  // at the step's start, to come back to when it fails
  std::vector<Real> last_angle_;
  std::vector<Twist<Real>> last_twist_;
  std::int64_t step_ = 0;
  int asked_substeps_ = 0;  // as planned before anything moved
  int sweeps_ = 1;          // over contacts and joints, of each pass in this step
  int joint_count_ = 0;
  bool masses_differ_ = false;  // so far that there may be such
  bool profiling_ = false;
  bool contacts_changed_ = true;  // since the impact stage looked at them
  Statistics statistics_;
  std::unique_ptr<plumb::Watch<Real>> watch_;
  std::optional<Error> doubt_;
};

/// Empty, or why a Realtime driver cannot run `scene` (a valid one).
std::string realtime_unsupported(const Scene& scene, const Realtime& accuracy);

}  // namespace plumb
