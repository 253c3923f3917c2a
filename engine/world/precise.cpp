#include "engine/world/precise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "engine/integrate/compensated.h"
#include "engine/integrate/dop853.h"
#include "engine/integrate/step_control.h"
#include "engine/scene/error.h"
#include "engine/world/precise_clock.h"
#include "engine/world/precise_flight.h"
#include "engine/world/precise_impacts.h"
#include "engine/world/precise_motion.h"
#include "engine/world/precise_parts.h"
#include "engine/world/precise_plan.h"

namespace plumb::precise {
namespace {

/// Of `Precise::tolerance`: what a step's estimated error may be. Errors add up over thousands of steps and
/// grow along chaotic motion; a method of order 8 pays 1.8 times the steps for these two digits.
constexpr double kLocalShare = 1e-2;
/// Below this the estimate is rounding.
constexpr double kLeastTolerance = 1e-15;
/// Impacts, and steps, within one max_dt: more of them do not end.
constexpr int kMostImpacts = 50000, kMostSteps = 200000;

class PreciseDriver final : public Driver {
 public:
  PreciseDriver(const Scene& scene, const Precise& precise, CompileOptions options)
      : max_dt_(precise.max_dt),
        tolerance_(std::max(kLocalShare * precise.tolerance, kLeastTolerance)),
        parts_(divide(scene)),
        scales_(scales_of(scene, parts_)),
        plan_(plan_of(scene, parts_, options.every_stage)),
        flight_(scene, parts_),
        equations_(scene, parts_, flight_, options.every_stage),
        runge_kutta_(equations_.dimension()),
        y_(equations_.dimension()),
        trial_(equations_.dimension()),
        end_rate_(equations_.dimension()),
        error_scale_(equations_.dimension()),
        impacts_(scene, parts_),
        start_(scene.bodies.size()),
        end_(scene.bodies.size()),
        normal_response_(scene.bodies.size()),
        tangent_response_(scene.bodies.size()) {
    for (const Body& body : scene.bodies) names_.push_back(body.name);
    for (std::size_t slot = 0; slot < parts_.integrated.size(); ++slot) {
      EquationsOfMotion::set_state(y_, slot, initial_state(scene.bodies[parts_.integrated[slot]]));
    }
  }

  void step() override {
    const double end = static_cast<double>(grid_steps_ + 1) * max_dt_;
    impacts_in_step_ = steps_in_step_ = 0;
    close_joints();
    while (time_ < end) {
      if (active(kResolve)) resolve_impacts();
      double next = std::min(end, next_switch());
      if (active(kImpactSearch)) next = std::min(next, time_ + impacts_.longest_step(start_));
      if (active(kRungeKutta)) next = integrate(next);
      if (active(kImpactSearch)) next = stop_at_impact(next);
      move_to(next);
    }
    ++grid_steps_;
    check_finite();
    report_cost();
  }

  double time() const override { return time_; }

  void read(std::span<BodyState> out) const override {
    for (const std::size_t body : parts_.flying) out[body] = flight_.at(body, time_).state;
    for (std::size_t slot = 0; slot < parts_.integrated.size(); ++slot) {
      out[parts_.integrated[slot]] = EquationsOfMotion::state(y_.value(), slot);
    }
  }

  void write(std::size_t body, const BodyState& state) override {
    if (flight_.holds(body)) {
      flight_.restart(body, time_, state);
    } else {
      EquationsOfMotion::set_state(y_, slot_of(body), state);
    }
    joints_closed_ = false;
    proposed_step_ = 0;
  }

  std::vector<std::byte> save() const override;
  void restore(std::span<const std::byte> snapshot) override;

  const Plan& plan() const override { return plan_; }
  void profile(bool on) override {
    profiling_ = equations_.cost.on = on;
    equations_.cost.forces = equations_.cost.joints = 0;
    for (Stage& stage : plan_.stages) stage.nanoseconds = 0;
    cost_ = {};
  }
  Statistics statistics() const override {
    Statistics all = statistics_;
    all.evaluations = equations_.evaluations();
    return all;
  }

 private:
  bool active(StageIndex stage) const { return plan_.stages[stage].active; }

  void close_joints();
  void resolve_impacts();
  double integrate(double limit);
  double stop_at_impact(double next);
  void move_to(double next);

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
  [[noreturn]] void fail(std::size_t body, const std::string& field, const std::string& problem) const;

  double max_dt_, tolerance_;
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

  double time_ = 0;
  std::int64_t grid_steps_ = 0;
  double proposed_step_ = 0;  // s; 0: none yet
  bool joints_closed_ = false;
  Statistics statistics_{};
  int impacts_in_step_ = 0, steps_in_step_ = 0;
  bool profiling_ = false;
  std::array<double, kStageCount> cost_{};
};

/// Once, and after bodies were moved from outside: closes joints and their velocities.
void PreciseDriver::close_joints() {
  if (joints_closed_) return;
  const Clock clock(profiling_, cost_[kProjection]);
  if (active(kProjection)) equations_.project(time_, y_);
  control_.reset();
  joints_closed_ = true;
}

/// Pairs that touch and approach bounce, one after the other, until none does.
void PreciseDriver::resolve_impacts() {
  const Clock clock(profiling_, cost_[kResolve]);
  motions(time_, y_.value(), {}, start_);
  while (const auto impact = impacts_.touching(time_, start_)) {
    if (++impacts_in_step_ > kMostImpacts) {
      throw Error(
          Error::Kind::Run,
          "bodies '" + names_[impacts_.discs()[impact->disc_a].body] + "' and '" +
              names_[impacts_.discs()[impact->disc_b].body] + "'",
          "time", std::to_string(time_) + " s",
          "do not stop hitting each other: Precise has no resting contact; use Realtime for this scene");
    }
    strike(*impact);
    motions(time_, y_.value(), {}, start_);
  }
}

/// One impact: impulses along its normal and tangent, which joints pass on.
void PreciseDriver::strike(const Impact& impact) {
  const auto [normal, tangent] = impacts_.directions(impact, start_);
  equations_.respond(time_, y_.value(), normal, normal_response_);
  equations_.respond(time_, y_.value(), tangent, tangent_response_);
  const std::size_t a = normal.a, b = normal.b;
  const auto along = [&](const Row<double>& row, const Twist<double>& of_a, const Twist<double>& of_b) {
    return dot(row.linear_a, of_a.velocity) + row.angular_a * of_a.angular_velocity +
           dot(row.linear_b, of_b.velocity) + row.angular_b * of_b.angular_velocity;
  };
  const auto twist = [&](std::size_t body) {
    return Twist<double>{start_[body].state.velocity, start_[body].state.angular_velocity};
  };
  const double nn = along(normal, normal_response_[a], normal_response_[b]);
  if (!(nn > 0)) fail(a, "time", "is hit where its joints hold it fast: nothing can give way");
  const auto [push, rub] =
      impacts_.impulse(impact, along(normal, twist(a), twist(b)), along(tangent, twist(a), twist(b)), nn,
                       along(tangent, normal_response_[a], normal_response_[b]),
                       along(tangent, tangent_response_[a], tangent_response_[b]));
  for (const std::size_t body : {a, b}) {
    if (!flight_.holds(body)) continue;
    BodyState state = start_[body].state;
    state.velocity += push * normal_response_[body].velocity + rub * tangent_response_[body].velocity;
    state.angular_velocity +=
        push * normal_response_[body].angular_velocity + rub * tangent_response_[body].angular_velocity;
    flight_.restart(body, time_, state);
  }
  equations_.kick(normal_response_, push, y_);
  equations_.kick(tangent_response_, rub, y_);
  ++statistics_.impacts;
}

/// Tries a Runge-Kutta step towards `limit` until its error is small enough; returns where it ends.
double PreciseDriver::integrate(double limit) {
  if (y_.size() == 0) return limit;
  const Clock clock(profiling_, cost_[kRungeKutta]);
  equations_.set_window(time_, limit);
  equations_.rate(time_, y_.value(), runge_kutta_.first_rate());
  set_error_scale();
  if (proposed_step_ == 0) proposed_step_ = first_step();
  for (;;) {
    const double left = limit - time_;
    const double parts = std::ceil(left / proposed_step_);
    const double end = parts > 1 ? time_ + left / parts : limit;  // no short last step
    const double h = end - time_;
    if (!(h > 4 * std::numeric_limits<double>::epsilon() * time_) && end < limit) blame_fastest();
    runge_kutta_.step(equations_, time_, h, y_.value());
    const double error = runge_kutta_.error(h, error_scale_);
    if (error <= 1) {
      const double next = h * control_.after_acceptance(error);
      proposed_step_ = h < proposed_step_ ? std::max(next, proposed_step_) : next;
      take_increment(end);
      return end;
    }
    ++statistics_.rejected;
    proposed_step_ = h * StepControl::after_rejection(error);
    if (proposed_step_ < std::numeric_limits<double>::min()) blame_fastest();
  }
}

/// trial = y + increment, with joints closed.
void PreciseDriver::take_increment(double end) {
  trial_ = y_;
  for (std::size_t i = 0; i < y_.size(); ++i) trial_.add(i, runge_kutta_.increment()[i]);
  if (!active(kProjection)) return;
  const Clock clock(profiling_, cost_[kProjection]);
  equations_.project(end, trial_);
}

/// Looks for impacts up to `next`. Where there is one, the step is cut there, at a time located by Newton's
/// method on the motion itself.
double PreciseDriver::stop_at_impact(double next) {
  const Clock clock(profiling_, cost_[kImpactSearch]);
  motions(time_, y_.value(), runge_kutta_.first_rate(), start_);
  if (y_.size() > 0) equations_.rate(next, trial_.value(), end_rate_);
  motions(next, trial_.value(), end_rate_, end_);
  const auto impact = impacts_.first(time_, next, start_, end_);
  if (!impact) return next;

  constexpr int kMostRefinements = 12;
  double time = impact->time;
  for (int i = 0;; ++i) {
    time = std::clamp(time, std::nextafter(time_, next), next);
    if (y_.size() > 0) {
      runge_kutta_.step(equations_, time_, time - time_, y_.value());
      take_increment(time);
    }
    motions(time, trial_.value(), {}, end_);
    const Encounter e = impacts_.encounter(*impact, end_);
    const double correction = e.gap / e.speed;
    const bool grazing = e.speed >= -e.quiet;
    if (grazing || i == kMostRefinements || std::abs(e.gap) <= e.noise / 16 || time - correction == time)
      return time;
    time -= correction;
  }
}

void PreciseDriver::move_to(double next) {
  if (++steps_in_step_ > kMostSteps) blame_fastest();
  std::swap(y_, trial_);
  time_ = next;
  ++statistics_.steps;
  if (std::binary_search(parts_.switches.begin(), parts_.switches.end(), next)) flight_.switch_forces(next);
}

double PreciseDriver::next_switch() const {
  const auto next = std::upper_bound(parts_.switches.begin(), parts_.switches.end(), time_);
  return next == parts_.switches.end() ? std::numeric_limits<double>::infinity() : *next;
}

/// What an error of 1 is, by component: the tolerance times the scene's length and speed, a body's own speed
/// where that is more, and one radian.
void PreciseDriver::set_error_scale() {
  for (std::size_t slot = 0; slot < parts_.integrated.size(); ++slot) {
    const BodyState now = EquationsOfMotion::state(y_.value(), slot);
    const double speed = std::max(scales_.speed, std::sqrt(length_squared(now.velocity)));
    const double spin = std::max(scales_.speed / scales_.length, std::abs(now.angular_velocity));
    const double scale[EquationsOfMotion::kPerBody] = {scales_.length, scales_.length, 1, speed, speed, spin};
    for (std::size_t i = 0; i < EquationsOfMotion::kPerBody; ++i) {
      error_scale_[EquationsOfMotion::kPerBody * slot + i] = tolerance_ * scale[i];
    }
  }
}

/// A tenth of the time in which anything changes by its scale.
double PreciseDriver::first_step() const {
  double fastest = 0;
  for (std::size_t i = 0; i < y_.size(); ++i) {
    fastest = std::max(fastest, std::abs(runge_kutta_.first_rate()[i]) * (tolerance_ / error_scale_[i]));
  }
  return fastest > 0 ? 0.1 / fastest : max_dt_;
}

/// The motions of bodies with discs. `rate` may be empty: then accelerations are zero where they are
/// integrated.
void PreciseDriver::motions(double time, std::span<const double> y, std::span<const double> rate,
                            std::span<Motion> out) const {
  for (const Disc& disc : impacts_.discs()) {
    if (flight_.holds(disc.body)) {
      out[disc.body] = flight_.at(disc.body, time);
      continue;
    }
    const std::size_t slot = slot_of(disc.body);
    Motion& motion = out[disc.body];
    motion = {EquationsOfMotion::state(y, slot), {}, 0};
    if (rate.empty()) continue;
    const double* change = rate.data() + EquationsOfMotion::kPerBody * slot;
    motion.acceleration = {change[3], change[4]};
    motion.angular_acceleration = change[5];
  }
}

std::size_t PreciseDriver::slot_of(std::size_t body) const {
  const auto place = std::lower_bound(parts_.integrated.begin(), parts_.integrated.end(), body);
  return static_cast<std::size_t>(place - parts_.integrated.begin());
}

void PreciseDriver::check_finite() {
  const auto finite = [](const BodyState& s) {
    return std::isfinite(s.position.x) && std::isfinite(s.position.y) && std::isfinite(s.angle) &&
           std::isfinite(s.velocity.x) && std::isfinite(s.velocity.y) && std::isfinite(s.angular_velocity);
  };
  if (active(kPolynomialFlight)) {
    const Clock clock(profiling_, cost_[kPolynomialFlight]);
    for (const std::size_t body : parts_.flying) {
      if (!finite(flight_.at(body, time_).state)) fail(body, "state", "is not finite");
    }
  }
  for (std::size_t slot = 0; slot < parts_.integrated.size(); ++slot) {
    if (!finite(EquationsOfMotion::state(y_.value(), slot)))
      fail(parts_.integrated[slot], "state", "is not finite");
  }
}

void PreciseDriver::fail(std::size_t body, const std::string& field, const std::string& problem) const {
  throw Error(Error::Kind::Run, "body '" + names_[body] + "'", field,
              "step " + std::to_string(grid_steps_ + 1) + ", " + std::to_string(time_) + " s", problem);
}

/// A step cannot be made small enough: names the body that changes fastest, or is not finite.
void PreciseDriver::blame_fastest() const {
  std::size_t worst = 0;
  double fastest = -1;
  for (std::size_t i = 0; i < y_.size(); ++i) {
    const double change = std::abs(runge_kutta_.first_rate()[i]) / error_scale_[i];
    if (change <= fastest) continue;
    worst = parts_.integrated[i / EquationsOfMotion::kPerBody];
    if (!std::isfinite(change)) fail(worst, "acceleration", "is not finite");
    fastest = change;
  }
  fail(worst, "step size", "changes too fast for any step: a larger tolerance or a Realtime run may do");
}

void PreciseDriver::report_cost() {
  if (!profiling_) return;
  cost_[kForces] = equations_.cost.forces;
  cost_[kJointAccelerations] = equations_.cost.joints;
  for (int i = 0; i < kStageCount; ++i) plan_.stages[i].nanoseconds = cost_[i];
  double& rest =
      plan_.stages[kRungeKutta].nanoseconds;  // what its evaluations and the projection did not take
  rest = std::max(0.0, rest - cost_[kForces] - cost_[kJointAccelerations] - cost_[kProjection]);
}

/// Snapshots are numbers of 8 bytes, one after the other.
std::vector<std::byte> PreciseDriver::save() const {
  std::vector<double> numbers{time_, static_cast<double>(grid_steps_), proposed_step_, control_.previous(),
                              joints_closed_ ? 1.0 : 0.0};
  for (const std::int64_t n :
       {statistics_.steps, statistics_.rejected, statistics_.impacts, equations_.evaluations()}) {
    numbers.push_back(static_cast<double>(n));
  }
  numbers.insert(numbers.end(), y_.value().begin(), y_.value().end());
  numbers.insert(numbers.end(), y_.carry().begin(), y_.carry().end());
  const auto arcs = std::as_bytes(std::span(flight_.arcs()));
  const auto head = std::as_bytes(std::span(numbers));
  std::vector<std::byte> snapshot(head.begin(), head.end());
  snapshot.insert(snapshot.end(), arcs.begin(), arcs.end());
  return snapshot;
}

void PreciseDriver::restore(std::span<const std::byte> snapshot) {
  constexpr std::size_t kHead = 9;
  std::vector<double> numbers(kHead + 2 * y_.size());
  const std::size_t head_size = numbers.size() * sizeof(double);
  std::vector<Flight::Arc>& arcs = flight_.arcs();
  if (snapshot.size() != head_size + arcs.size() * sizeof(Flight::Arc)) {
    throw Error(Error::Kind::Value, "snapshot", "size", std::to_string(snapshot.size()),
                "is not of this scene and accuracy");
  }
  std::memcpy(numbers.data(), snapshot.data(), head_size);
  if (!arcs.empty()) std::memcpy(arcs.data(), snapshot.data() + head_size, arcs.size() * sizeof(Flight::Arc));
  time_ = numbers[0];
  grid_steps_ = static_cast<std::int64_t>(numbers[1]);
  proposed_step_ = numbers[2];
  control_.reset(numbers[3]);
  joints_closed_ = numbers[4] != 0;
  statistics_ = {static_cast<std::int64_t>(numbers[5]), static_cast<std::int64_t>(numbers[6]),
                 static_cast<std::int64_t>(numbers[7]), 0};
  equations_.set_evaluations(static_cast<std::int64_t>(numbers[8]));
  for (std::size_t i = 0; i < y_.size(); ++i) y_.set(i, numbers[kHead + i], numbers[kHead + y_.size() + i]);
}

}  // namespace
}  // namespace plumb::precise

namespace plumb {

std::unique_ptr<Driver> make_precise_driver(const Scene& scene, const Precise& precise,
                                            CompileOptions options) {
  return std::make_unique<precise::PreciseDriver>(scene, precise, options);
}

}  // namespace plumb
