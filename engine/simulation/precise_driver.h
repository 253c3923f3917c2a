#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/integrate/compensated.h"
#include "engine/integrate/dop853.h"
#include "engine/integrate/step_control.h"
#include "engine/scene/scene.h"
#include "engine/simulation/accuracy.h"
#include "engine/simulation/driver.h"
#include "engine/simulation/precise_flight.h"
#include "engine/simulation/precise_impacts.h"
#include "engine/simulation/precise_motion.h"
#include "engine/simulation/precise_parts.h"
#include "engine/simulation/precise_plan.h"
#include "engine/simulation/simulation.h"

namespace plumb::precise {

/// What `make_precise_driver` makes.
class PreciseDriver final : public Driver {
 public:
  PreciseDriver(const Scene& scene, const Precise& precise, CompileOptions options);

  void step() override;
  double time() const override { return time_; }
  void read(std::span<BodyState> out) const override;
  void write(std::size_t body, const BodyState& state) override;
  std::vector<std::byte> save() const override;
  void restore(std::span<const std::byte> snapshot) override;
  const Plan& plan() const override { return plan_; }
  void profile(bool on) override;
  Statistics statistics() const override;

 private:
  bool active(StageIndex stage) const { return plan_.stages[stage].active; }

  // A step, in this order.
  void close_joints();
  void resolve_impacts();
  double integrate(double limit);
  double stop_at_impact(double next);
  void move_to(double next);

  // What those are made of.
  double next_switch() const;
  void take_increment(double end);
  double first_step() const;
  void set_error_scale();
  void motions(double time, std::span<const double> y, std::span<const double> rate,
               std::span<Motion> out) const;
  void strike(const Impact& impact);
  std::size_t slot_of(std::size_t body) const;
  void check_finite();
  void report_cost();
  [[noreturn]] void blame_fastest() const;
  [[noreturn]] void fail(const std::string& subject, const std::string& field, const std::string& value,
                         const std::string& problem) const;

  const double max_dt_, tolerance_;
  Parts parts_;
  Scales scales_;
  Plan plan_;
  Flight flight_;
  EquationsOfMotion equations_;
  Dop853 runge_kutta_;
  StepControl control_;
  Compensated y_, trial_;  // of the integrated bodies: now, and at the end of the step that is being tried
  std::vector<double> end_rate_, error_scale_;
  Impacts impacts_;
  std::vector<Motion> start_, end_;  // by body, of those with discs
  std::vector<Twist<double>> normal_response_, tangent_response_;
  std::vector<std::string> names_;
  std::vector<char> at_rest_, locked_;  // by body: static; without rotation

  double time_ = 0;
  std::int64_t grid_steps_ = 0;
  double proposed_step_ = 0;  // s; 0: none yet
  bool joints_closed_ = false;
  Statistics statistics_{};
  int impacts_in_step_ = 0, steps_in_step_ = 0;
  bool profiling_ = false;
  std::array<double, kStageCount> cost_{};
};

}  // namespace plumb::precise
