#include "engine/simulation/precise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/simulation/precise_clock.h"
#include "engine/simulation/precise_driver.h"

namespace plumb::precise {
namespace {

/// Of `Precise::tolerance`: what a step's estimated error may be. Errors add up over thousands of steps and
/// grow along chaotic motion; a method of order 8 pays 1.8 times the steps for these two digits.
constexpr double kLocalShare = 1e-2;
/// Below this the estimate is rounding.
constexpr double kLeastTolerance = 1e-15;
/// Impacts, and steps, within one max_dt: more of them do not end.
constexpr int kMostImpacts = 20000, kMostSteps = 200000;

}  // namespace

void PreciseDriver::step() {
  const double end = static_cast<double>(grid_steps_ + 1) * max_dt_;
  impacts_in_step_ = steps_in_step_ = 0;
  close_joints();
  while (time_ < end) {
    if (active(kResolve)) resolve_impacts();
    double next = std::min(end, next_switch());
    if (active(kImpactSearch)) next = std::min(next, time_ + impacts_.longest_step(start_));
    if (active(kRungeKutta)) next = integrate(next);         // what is not on a polynomial; often less far
    if (active(kImpactSearch)) next = stop_at_impact(next);  // the first one on the way
    move_to(next);
  }
  check_finite();
  ++grid_steps_;
  report_cost();
}

PreciseDriver::PreciseDriver(const Scene& scene, const Precise& precise, CompileOptions options)
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
  for (const Body& body : scene.bodies) {
    names_.push_back(body.name);
    at_rest_.push_back(body.type == BodyType::Static);
    locked_.push_back(body.fixed_rotation);
  }
  for (std::size_t slot = 0; slot < parts_.integrated.size(); ++slot) {
    EquationsOfMotion::set_state(y_, slot, initial_state(scene.bodies[parts_.integrated[slot]]));
  }
}

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
      const auto name = [&](std::size_t disc) { return "'" + names_[impacts_.discs()[disc].body] + "'"; };
      fail("bodies " + name(impact->disc_a) + " and " + name(impact->disc_b), "impacts",
           std::to_string(kMostImpacts) + " and more",
           "they do not stop: Precise has no resting contact; use Realtime");
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
  if (!(nn > 0))
    fail("body '" + names_[a] + "'", "effective mass", "infinite",
         "an impact meets joints that hold everything fast: nothing can give way");
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

}  // namespace plumb::precise

namespace plumb {

std::unique_ptr<Driver> make_precise_driver(const Scene& scene, const Precise& precise,
                                            CompileOptions options) {
  return std::make_unique<precise::PreciseDriver>(scene, precise, options);
}

}  // namespace plumb
