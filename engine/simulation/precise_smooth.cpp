#include "engine/simulation/precise_smooth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/error.h"
#include "engine/scene/text.h"
#include "engine/simulation/precise_clock.h"

namespace plumb::precise {
namespace {

constexpr std::size_t kPerBody = EquationsOfMotion::kPerBody;

/// Of `Precise::tolerance`: what a step's estimated error may be. Errors add up over thousands of steps and
/// grow along chaotic motion; a method of order 8 pays 2.4 times the steps for these three digits.
constexpr double kLocalShare = 1e-3;
/// Below this the estimate is rounding.
constexpr double kLeastTolerance = 1e-15;
/// A step is at most this many times as long as the scene's accelerations take over its length: where nothing
/// moves, nothing else would bound it.
constexpr double kLongestStep = 100;

}  // namespace

SmoothMotion::SmoothMotion(const Scene& scene, const Parts& parts, const Precise& precise,
                           EquationsOfMotion& equations)
    : tolerance_(std::max(kLocalShare * precise.tolerance, kLeastTolerance)),
      scales_(scales_of(scene, parts)),
      longest_step_(kLongestStep * scales_.length / scales_.speed),
      bodies_(parts.integrated),
      switches_(parts.switches),
      equations_(equations),
      method_(equations.dimension()),
      y0_(equations.dimension()),
      y_(equations.dimension()),
      polynomial_(equations.dimension()),
      error_scale_(equations.dimension()) {
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const Body& body = scene.bodies[bodies_[slot]];
    names_.push_back(body.name);
    EquationsOfMotion::set_state(y_, slot, initial_state(body));
  }
  y0_ = y_;
}

double SmoothMotion::step(double limit) {
  limit = std::min(limit, next_switch());
  if (y_.size() == 0) {
    start_ = time_;
    return time_ = limit;
  }
  equations_.set_window(time_, time_);  // what is switched on now stays on to the end of the step
  const bool switched = std::binary_search(switches_.begin(), switches_.end(), time_);
  if (rate_known_ && !switched) {
    method_.advance();
  } else {
    equations_.rate(time_, y_.value(), method_.first_rate());
  }
  start_ = time_;
  y0_ = y_;
  set_error_scale();
  if (proposed_step_ == 0) proposed_step_ = first_step();
  for (;;) {
    const double end = end_of_step(limit), h = end - start_;
    if (!(h > 4 * std::numeric_limits<double>::epsilon() * start_) && end < limit) blame_fastest();
    method_.step(equations_, start_, h, y0_.value());
    const double error = method_.error(h, error_scale_);
    if (error <= 1) {
      const double next = std::min(h * control_.after_acceptance(error), longest_step_);
      proposed_step_ = h < proposed_step_ ? std::max(next, proposed_step_) : next;
      take_increment(end);
      return end;
    }
    ++rejected_;
    proposed_step_ = h * StepControl::after_rejection(error);
    if (proposed_step_ < std::numeric_limits<double>::min()) blame_fastest();
  }
}

/// The proposed step, or an equal share of the way to `limit`: no short last step.
double SmoothMotion::end_of_step(double limit) const {
  const double left = limit - start_;
  const double parts = std::ceil(left / proposed_step_);
  if (parts <= 1) return limit;
  return start_ + (parts < 100 ? left / parts : proposed_step_);
}

/// y = y0 + increment, with joints closed.
void SmoothMotion::take_increment(double end) {
  y_ = y0_;
  for (std::size_t i = 0; i < y_.size(); ++i) y_.add(i, method_.increment()[i]);
  project(end, y_);
  time_ = end;
  polynomial_known_ = rate_known_ = false;
}

void SmoothMotion::project(double time, Compensated& y) {
  const Clock clock(equations_.cost.on, projection_nanoseconds);
  equations_.project(time, y);
}

std::span<const double> SmoothMotion::rate_at_end() {
  if (!rate_known_) equations_.rate(time_, y_.value(), method_.last_rate());
  rate_known_ = true;
  return method_.last_rate();
}

const StepPolynomial& SmoothMotion::polynomial() {
  if (!polynomial_known_) {
    rate_at_end();
    method_.polynomial(equations_, start_, time_ - start_, y0_.value(), polynomial_);
    polynomial_known_ = true;
  }
  return polynomial_;
}

void SmoothMotion::at(double time, bool project_too, Compensated& out) {
  if (time == time_) {
    out = y_;
    return;
  }
  out = y0_;
  if (time == start_) return;
  const StepPolynomial& path = polynomial();
  const double s = (time - start_) / (time_ - start_);
  for (std::size_t i = 0; i < out.size(); ++i) out.add(i, path.at(s, i));
  if (project_too) project(time, out);
}

void SmoothMotion::cut(double time) {
  if (y_.size() > 0) {
    method_.step(equations_, start_, time - start_, y0_.value());
    take_increment(time);
  }
  time_ = time;
}

void SmoothMotion::rewind(double time) {
  if (time == time_) return;
  Compensated y(y_.size());
  at(time, true, y);
  y_ = y;
  time_ = time;
  restart();
}

void SmoothMotion::restart() {
  start_ = time_;
  y0_ = y_;
  polynomial_known_ = rate_known_ = false;
}

void SmoothMotion::start_anew() {
  project(time_, y_);
  control_.reset();
  proposed_step_ = 0;
  restart();
}

double SmoothMotion::next_switch() const {
  const auto next = std::upper_bound(switches_.begin(), switches_.end(), time_);
  return next == switches_.end() ? std::numeric_limits<double>::infinity() : *next;
}

/// What an error of 1 is, by component: the tolerance times the scene's length and speed, a body's own speed
/// where that is more, and one radian.
void SmoothMotion::set_error_scale() {
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const BodyState now = EquationsOfMotion::state(y_.value(), slot);
    const double speed = std::max(scales_.speed, std::sqrt(length_squared(now.velocity)));
    const double spin = std::max(scales_.speed / scales_.length, std::abs(now.angular_velocity));
    const double scale[kPerBody] = {scales_.length, scales_.length, 1, speed, speed, spin};
    for (std::size_t i = 0; i < kPerBody; ++i) error_scale_[kPerBody * slot + i] = tolerance_ * scale[i];
  }
}

/// A tenth of the time in which anything changes by its scale.
double SmoothMotion::first_step() const {
  double fastest = 0;
  for (std::size_t i = 0; i < y_.size(); ++i) {
    fastest = std::max(fastest, std::abs(method_.first_rate()[i]) * (tolerance_ / error_scale_[i]));
  }
  return fastest > 0 ? std::min(0.1 / fastest, longest_step_) : longest_step_;
}

void SmoothMotion::blame_fastest() const {
  std::size_t worst = 0;
  double fastest = -1;
  for (std::size_t i = 0; i < y_.size() && !std::isnan(fastest); ++i) {
    const double change = std::abs(method_.first_rate()[i]) / error_scale_[i];
    if (change <= fastest) continue;
    worst = i;
    fastest = change;
  }
  const std::string subject = names_.empty() ? "the scene" : "body '" + names_[worst / kPerBody] + "'";
  if (!std::isfinite(fastest))
    throw Error(Error::Kind::Run, subject, "acceleration", shortest(fastest), "not finite");
  throw Error(Error::Kind::Run, subject, "step", shortest(proposed_step_) + " s",
              "the motion changes too fast for any step; a larger tolerance or Realtime may do");
}

void SmoothMotion::save(double sampled, SnapshotWriter& out) {
  const bool with_polynomial = sampled < time_ && sampled > start_ && y_.size() > 0;
  if (with_polynomial) polynomial();
  for (const double number : {start_, time_, proposed_step_, control_.previous()}) out.put(number);
  out.put(rejected_);
  out.put(with_polynomial ? std::int64_t{polynomial_.degree()} : std::int64_t{0});
  out.put(std::int64_t{rate_known_});
  const auto put = [&](std::span<const double> numbers) {
    for (const double number : numbers) out.put(number);
  };
  for (const Compensated* y : {&y0_, &y_}) put(y->value()), put(y->carry());
  if (rate_known_) put(method_.last_rate());
  if (!with_polynomial) return;
  put(polynomial_.nodes());
  for (int k = 1; k <= polynomial_.degree(); ++k) put(polynomial_.term(k));
}

void SmoothMotion::restore(SnapshotReader& in) {
  double previous = 0;
  for (double* number : {&start_, &time_, &proposed_step_, &previous}) *number = in.get<double>();
  control_.reset(previous);
  rejected_ = in.get<std::int64_t>();
  const auto degree = in.get<std::int64_t>();
  in.expect(degree >= 0 && degree <= StepPolynomial::kMostTerms);
  rate_known_ = in.get<std::int64_t>() != 0;
  std::vector<double> value(y_.size());
  const auto get = [&](std::span<double> numbers) {
    for (double& number : numbers) number = in.get<double>();
  };
  for (Compensated* y : {&y0_, &y_}) {
    get(value);
    for (std::size_t i = 0; i < value.size(); ++i) y->set(i, value[i], in.get<double>());
  }
  if (rate_known_) get(method_.last_rate());
  polynomial_known_ = degree > 0;
  std::vector<double> nodes(static_cast<std::size_t>(degree));
  get(nodes);
  polynomial_.set_nodes(nodes);
  for (int k = 1; k <= polynomial_.degree(); ++k) get(polynomial_.term(k));
  equations_.set_window(start_, start_);
}

}  // namespace plumb::precise
