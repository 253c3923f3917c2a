#include "engine/precise/integration/smooth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "engine/core/text.h"
#include "engine/precise/dynamics/clock.h"
#include "engine/scene/error.h"

namespace plumb::precise {
namespace {

/// Longest step, in units of the time in which the scene's accelerations cross its length: nothing else
/// limits the step when all bodies are at rest.
constexpr double kLongestStep = 1e6;
/// Longest step after a jump, as a multiple of the first step.
constexpr double kAfterJump = 1000;
/// Error reported for a step whose stages did not converge: the next attempt is a fifth as long.
constexpr double kNotFound = std::numeric_limits<double>::infinity();

}  // namespace

EventFreeIntegrator::EventFreeIntegrator(const Scene& scene, const Parts& parts, const Precise& precise,
                                         EquationsOfMotion& equations)
    : tolerance_(precise.tolerance / kSteps),
      scales_(scales_of(scene, parts)),
      longest_step_(kLongestStep * scales_.length / scales_.speed),
      bodies_(parts.integrated),
      switches_(parts.switches),
      equations_(equations),
      method_(precise.method),
      ballistic_(parts.ballistic),
      hanging_(scene, parts, equations, precise.method != MotionMethod::Symplectic),
      all_(equations, equations.dimension()),
      angles_(hanging_, hanging_.dimension()),
      implicit_(equations.dimension()),
      stiff_motion_(scene, parts, equations),
      symplectic_(equations),
      passage_(equations),
      control_(hanging_.empty() ? StepControl::kUsual : StepControl::kCareful),
      stiff_(precise.method == MotionMethod::Implicit),
      y0_(equations.dimension()),
      y_(equations.dimension()) {
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const Body& body = scene.bodies[bodies_[slot]];
    names_.push_back(body.name);
    EquationsOfMotion::set_state(y_, slot, initial_state(body));
  }
  y0_ = y_;
  redundant_joints_ = equations_.redundant_joints(0, y_.value());
}

/// Makes the end of the last step the start of the next.
void EventFreeIntegrator::begin() {
  equations_.set_window(time_, time_);  // forces that are switched on now act until the end of the step
  const bool switched = std::binary_search(switches_.begin(), switches_.end(), time_);
  if (rate_known_ && !switched) {
    now().method.advance();
  } else {
    equations_.forget_rank();
    now().flow.rate(time_, seen(y_), now().method.first_rate());
    now().method.set_first_power(now().flow.power());
    rank_at_start_ = {equations_.weakest(), equations_.dependent_rows()};
  }
  weakest_before_ = rank_at_start_.weakest;
  start_ = time_;
  y0_ = y_;
}

double EventFreeIntegrator::step(double limit) {
  limit = std::min(limit, next_switch());
  if (y_.size() == 0) {
    start_ = time_;
    return time_ = limit;
  }
  const bool first = !(time_ > start_);
  expect_passage();
  begin();
  if (flies()) {
    fly(limit);
    return limit;
  }
  last_flew_ = false;
  set_error_scale();
  if (method_ == MotionMethod::Symplectic) return symplectic_step(limit);
  if (jumped_) proposed_step_ = std::min(proposed_step_, kAfterJump * first_step());
  jumped_ = false;
  bool again = proposed_step_ == 0;
  if (proposed_step_ == 0) proposed_step_ = first_step();
  if (stiff_) stiff_motion_.linearise(start_, y0_.value());
  if (first) look_at_rows();
  if (near_) return step_near_crossing(limit);
  last_near_ = false;
  for (;;) {
    const double end = end_of_step(limit);
    const double h = end - start_;
    if (!(h > 4 * std::numeric_limits<double>::epsilon() * start_) && end < limit) throw_step_underflow();
    const double error = try_step(end, again);
    if (error <= 1) {
      last_implicit_ = stiff_;
      take_increment(end);
      equations_.forget_rank();
      rate_at_end();
      accept(h, error);
      return end;
    }
    again = true;
    ++rejected_;
    proposed_step_ = h * (stiff_ ? StepControl::sixth_order(error) : control_.after_rejection(error));
    if (proposed_step_ < std::numeric_limits<double>::min()) throw_step_underflow();
  }
}

/// Steps to `end` under constant forces alone: a parabola of any length, with constant accelerations.
void EventFreeIntegrator::fly(double end) {
  const double h = end - start_;
  const std::span<const double> rate = rate_at_start();
  const std::span<double> last = all_.method.last_rate();
  all_.polynomial.set_nodes(std::array{0.0, 1.0});
  const std::span<double> whole = all_.polynomial.term(1), bend = all_.polynomial.term(2);
  y_ = y0_;
  for (std::size_t i = 0; i < y_.size(); ++i) {
    const bool place = i % EquationsOfMotion::kPerBody < 3;
    const double gained = place ? h * rate[i + 3] : 0;  // change of speed
    bend[i] = 0.5 * h * gained;
    whole[i] = h * rate[i] + bend[i];
    last[i] = rate[i] + gained;
    y_.add(i, whole[i]);
  }
  time_ = end;
  last_implicit_ = jumped_ = false;
  last_flew_ = true;
  polynomial_known_ = rate_known_ = true;
}

/// Returns the error of a step to `end`; up to 1 it may be accepted. `again` is true for a first step and
/// after a failed one.
double EventFreeIntegrator::try_step(double end, bool again) {
  const double h = end - start_;
  if (!stiff_) {
    now().method.step(now().flow, start_, h, seen(y0_));
    return now().method.error(h, now().error_scale);
  }
  if (again) implicit_.forget();
  const std::span<const double> scale = all_.error_scale;
  const bool found = implicit_.step(stiff_motion_, start_, h, y0_.value(), rate_at_start(), scale);
  if (!found) return kNotFound;
  return implicit_.error(stiff_motion_, start_, h, y0_.value(), rate_at_start(), scale, again);
}

/// Accepts the last step, of length h.
void EventFreeIntegrator::accept(double h, double error) {
  const double factor = stiff_ ? StepControl::sixth_order(error) : control_.after_acceptance(error);
  const double next = std::min(h * factor, longest_step_);
  proposed_step_ = h < proposed_step_ ? std::max(next, proposed_step_) : next;
  implicit_steps_ += stiff_ ? 1 : 0;
  rank_at_start_ = {equations_.weakest(), equations_.dependent_rows()};
  if (method_ == MotionMethod::Automatic && !equations_.holds_anything()) watch_stiffness();
}

/// Returns the end of the next step. If the proposed step does not reach `limit`, divides the time to `limit`
/// into equal parts, which avoids a short last step.
double EventFreeIntegrator::end_of_step(double limit) const {
  const double left = limit - start_;
  const double parts = std::ceil(left / proposed_step_);
  if (parts <= 1) return limit;
  return start_ + (parts < 100 ? left / parts : proposed_step_);
}

/// Sets y = y0 + increment, with joints closed.
void EventFreeIntegrator::take_increment(double end) {
  y_ = y0_;
  const std::span<const double> increment =
      last_implicit_ ? implicit_.increment() : last().method.increment();
  if (was_in_angles()) {
    hanging_.add([&](std::size_t i) { return increment[i]; }, y_);
  } else {
    for (std::size_t i = 0; i < y_.size(); ++i) y_.add(i, increment[i]);
  }
  project(end, y_);
  time_ = end;
  polynomial_known_ = rate_known_ = false;
}

std::span<const double> EventFreeIntegrator::seen(const Compensated& y) {
  return in_angles() ? hanging_.taken_from(y.value()) : y.value();
}

void EventFreeIntegrator::project(double time, Compensated& y) {
  const Clock clock(equations_.cost.on, projection_nanoseconds);
  if (hanging_.empty()) {
    equations_.project(time, y);
  } else {
    hanging_.hang(time, y);
  }
}

std::span<const double> EventFreeIntegrator::rate_at_end() {
  if (!rate_known_) {
    now().flow.rate(time_, seen(y_), now().method.last_rate());
    now().method.set_last_power(now().flow.power());
  }
  rate_known_ = true;
  return now().method.last_rate();
}

std::optional<double> EventFreeIntegrator::work() const {
  if (method_ == MotionMethod::Symplectic) return std::nullopt;
  if (!equations_.has_forces()) return 0.0;
  if (last_implicit_ || last_flew_) return std::nullopt;
  return last().method.work(time_ - start_);
}

const StepPolynomial& EventFreeIntegrator::polynomial() {
  if (!polynomial_known_) {
    if (last_implicit_) {
      implicit_.polynomial(all_.polynomial);
    } else {
      rate_at_end();
      now().method.polynomial(flow_of_last(), start_, time_ - start_, seen(y0_), now().polynomial);
    }
    polynomial_known_ = true;
  }
  return last().polynomial;
}

void EventFreeIntegrator::at(double time, bool project_too, Compensated& out) {
  if (time == time_) {
    out = y_;
    return;
  }
  out = y0_;
  if (time == start_) return;
  if (method_ == MotionMethod::Symplectic) {
    symplectic_.step(start_, time - start_, out);
    return;
  }
  const StepPolynomial& path = polynomial();
  const double s = (time - start_) / (time_ - start_);
  if (was_in_angles()) {
    hanging_.add([&](std::size_t i) { return path.at(s, i); }, out);
  } else {
    for (std::size_t i = 0; i < out.size(); ++i) out.add(i, path.at(s, i));
  }
  if (!project_too && !was_in_angles()) return;
  if (last_near_) {
    // Rounding in weak rows would cause a larger error than the polynomial itself.
    constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
    const double tolerance = kSteps * tolerance_;
    equations_.hold_only_above(std::min(kRounding / tolerance, 0.1), tolerance * scales_.length);
  }
  project(time, out);
  equations_.hold_only_above(0, 0);
}

void EventFreeIntegrator::cut(double time) {
  if (y_.size() > 0 && flies()) {
    fly(time);
  } else if (y_.size() > 0 && last_implicit_) {
    implicit_.forget();
    const bool found =
        implicit_.step(stiff_motion_, start_, time - start_, y0_.value(), rate_at_start(), all_.error_scale);
    if (!found) throw_step_underflow();
    take_increment(time);
  } else if (y_.size() > 0) {
    now().method.step(flow_of_last(), start_, time - start_, seen(y0_));
    take_increment(time);
  }
  time_ = time;
}

void EventFreeIntegrator::rewind(double time) {
  if (time == time_) return;
  Compensated y(y_.size());
  at(time, true, y);
  y_ = y;
  time_ = time;
  restart();
}

void EventFreeIntegrator::restart() {
  start_ = time_;
  y0_ = y_;
  polynomial_known_ = rate_known_ = false;
  jumped_ = true;
  implicit_.forget();
  // The implicit method's Jacobian contains joints and forces, but not contacts: while contacts persist,
  // steps are explicit.
  if (equations_.holds_anything()) {
    stiff_ = false;
  } else if (method_ == MotionMethod::Implicit) {
    stiff_ = true;
  }
}

void EventFreeIntegrator::start_anew() {
  equations_.strike_hinges(time_, y_);
  project(time_, y_);
  control_.reset();
  proposed_step_ = 0;
  restart();
}

double EventFreeIntegrator::next_switch() const {
  const auto next = std::upper_bound(switches_.begin(), switches_.end(), time_);
  return next == switches_.end() ? std::numeric_limits<double>::infinity() : *next;
}

}  // namespace plumb::precise
