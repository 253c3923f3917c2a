#include "engine/precise/integration/integrator.h"

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
constexpr double kNotConverged = std::numeric_limits<double>::infinity();

}  // namespace

EventFreeIntegrator::EventFreeIntegrator(const Scene& scene, const ScenePartition& partition,
                                         const Precise& precise, EquationsOfMotion& equations)
    : tolerance_(precise.tolerance / kSteps),
      scales_(scales_of(scene, partition)),
      longest_step_(kLongestStep * scales_.length / scales_.speed),
      bodies_(partition.integrated),
      switches_(partition.switches),
      equations_(equations),
      method_(precise.method),
      constant_forces_(partition.constant_forces),
      tree_(scene, partition, equations, precise.method != MotionMethod::Symplectic),
      all_(equations, equations.dimension()),
      angles_(tree_, tree_.dimension()),
      implicit_(equations.dimension()),
      stiff_motion_(scene, partition, equations),
      symplectic_(equations),
      passage_(equations),
      control_(tree_.empty() ? StepControl::kUsual : StepControl::kCareful),
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
void EventFreeIntegrator::begin_step() {
  equations_.set_window(time_, time_);  // forces that are switched on now act until the end of the step
  const bool switched = std::binary_search(switches_.begin(), switches_.end(), time_);
  if (rate_known_ && !switched) {
    current().method.advance();
  } else {
    equations_.reset_rank();
    current().flow.rate(time_, coordinates_of(y_), current().method.first_rate());
    current().method.set_first_power(current().flow.power());
    rank_at_start_ = {equations_.min_pivot_ratio(), equations_.dependent_rows()};
  }
  previous_pivot_ratio_ = rank_at_start_.min_pivot_ratio;
  start_ = time_;
  y0_ = y_;
}

double EventFreeIntegrator::step(double limit) {
  equations_.set_window(time_, time_);
  limit = std::min(limit, next_switch());
  if (y_.size() == 0) {
    start_ = time_;
    return time_ = limit;
  }
  const bool first = !(time_ > start_);
  extrapolate_motion();
  begin_step();
  if (is_ballistic()) {
    ballistic_step(limit);
    return limit;
  }
  last_was_ballistic_ = false;
  set_error_scale();
  if (method_ == MotionMethod::Symplectic) return symplectic_step(limit);
  if (jumped_) proposed_step_ = std::min(proposed_step_, kAfterJump * first_step());
  jumped_ = false;
  bool again = proposed_step_ == 0;
  if (proposed_step_ == 0) proposed_step_ = first_step();
  if (stiff_) stiff_motion_.linearise(start_, y0_.value());
  if (first) check_initial_rank();
  if (near_singularity_) return step_near_singularity(limit);
  last_near_singularity_ = false;
  for (;;) {
    const double end = end_of_step(limit);
    const double h = end - start_;
    if (!(h > 4 * std::numeric_limits<double>::epsilon() * start_) && end < limit) throw_step_underflow();
    const double error = try_step(end, again);
    if (error <= 1) {
      last_implicit_ = stiff_;
      apply_increment(end);
      if (const std::optional<double> inside = time_in_passed_piece()) {
        y_ = y0_, time_ = start_;
        again = true, ++rejected_;
        proposed_step_ = *inside - start_;
        continue;
      }
      equations_.reset_rank();
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
void EventFreeIntegrator::ballistic_step(double end) {
  const double h = end - start_;
  const std::span<const double> rate = rate_at_start();
  const std::span<double> last = all_.method.last_rate();
  all_.polynomial.set_nodes(std::array{0.0, 1.0});
  const std::span<double> linear = all_.polynomial.term(1), quadratic = all_.polynomial.term(2);
  y_ = y0_;
  for (std::size_t i = 0; i < y_.size(); ++i) {
    const bool place = i % EquationsOfMotion::kPerBody < 3;
    const double gained = place ? h * rate[i + 3] : 0;  // change of speed
    quadratic[i] = 0.5 * h * gained;
    linear[i] = h * rate[i] + quadratic[i];
    last[i] = rate[i] + gained;
    y_.add(i, linear[i]);
  }
  time_ = end;
  last_implicit_ = jumped_ = false;
  last_was_ballistic_ = true;
  polynomial_known_ = rate_known_ = true;
}

/// Returns the error of a step to `end`; up to 1 it may be accepted. `again` is true for a first step and
/// after a failed one.
double EventFreeIntegrator::try_step(double end, bool again) {
  const double h = end - start_;
  if (!stiff_) {
    current().method.step(current().flow, start_, h, coordinates_of(y0_));
    return current().method.error(h, current().error_scale);
  }
  if (again) implicit_.forget();
  const std::span<const double> scale = all_.error_scale;
  const bool found = implicit_.step(stiff_motion_, start_, h, y0_.value(), rate_at_start(), scale);
  if (!found) return kNotConverged;
  return implicit_.error(stiff_motion_, start_, h, y0_.value(), rate_at_start(), scale, again);
}

/// Accepts the last step, of length h.
void EventFreeIntegrator::accept(double h, double error) {
  const double factor = stiff_ ? StepControl::sixth_order(error) : control_.after_acceptance(error);
  const double next = std::min(h * factor, longest_step_);
  proposed_step_ = h < proposed_step_ ? std::max(next, proposed_step_) : next;
  implicit_steps_ += stiff_ ? 1 : 0;
  rank_at_start_ = {equations_.min_pivot_ratio(), equations_.dependent_rows()};
  if (method_ == MotionMethod::Automatic && !equations_.has_active_constraints()) update_stiffness();
}

/// Returns the end of the next step. If the proposed step does not reach `limit`, divides the time to `limit`
/// into equal parts, which avoids a short last step.
double EventFreeIntegrator::end_of_step(double limit) const {
  const double left = limit - start_;
  const double count = std::ceil(left / proposed_step_);
  if (count <= 1) return limit;
  return start_ + (count < 100 ? left / count : proposed_step_);
}

/// Sets y = y0 + increment, with joints closed.
void EventFreeIntegrator::apply_increment(double end) {
  y_ = y0_;
  const std::span<const double> increment =
      last_implicit_ ? implicit_.increment() : last().method.increment();
  if (last_used_angles()) {
    tree_.add_to_angles([&](std::size_t i) { return increment[i]; }, y_);
  } else {
    for (std::size_t i = 0; i < y_.size(); ++i) y_.add(i, increment[i]);
  }
  project(end, y_);
  time_ = end;
  polynomial_known_ = rate_known_ = false;
}

std::span<const double> EventFreeIntegrator::coordinates_of(const Compensated& y) {
  return uses_angles() ? tree_.angles_of(y.value()) : y.value();
}

void EventFreeIntegrator::project(double time, Compensated& y) {
  const Clock clock(equations_.cost.on, projection_nanoseconds);
  if (tree_.empty()) {
    equations_.project(time, y);
  } else {
    tree_.forward_kinematics(time, y);
  }
}

std::span<const double> EventFreeIntegrator::rate_at_end() {
  if (!rate_known_) {
    current().flow.rate(time_, coordinates_of(y_), current().method.last_rate());
    current().method.set_last_power(current().flow.power());
  }
  rate_known_ = true;
  return current().method.last_rate();
}

std::optional<double> EventFreeIntegrator::work() const {
  if (method_ == MotionMethod::Symplectic) return std::nullopt;
  if (!equations_.has_forces()) return 0.0;
  if (last_implicit_ || last_was_ballistic_) return std::nullopt;
  return last().method.work(time_ - start_);
}

const StepPolynomial& EventFreeIntegrator::polynomial() {
  if (!polynomial_known_) {
    if (last_implicit_) {
      implicit_.polynomial(all_.polynomial);
    } else {
      rate_at_end();
      current().method.polynomial(flow_of_last(), start_, time_ - start_, coordinates_of(y0_),
                                  current().polynomial);
    }
    polynomial_known_ = true;
  }
  return last().polynomial;
}

void EventFreeIntegrator::at(double time, bool project_joints, Compensated& out) {
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
  if (last_used_angles()) {
    tree_.add_to_angles([&](std::size_t i) { return path.at(s, i); }, out);
  } else {
    for (std::size_t i = 0; i < out.size(); ++i) out.add(i, path.at(s, i));
  }
  if (!project_joints && !last_used_angles()) return;
  if (last_near_singularity_) {
    // Rounding in weak rows would cause a larger error than the polynomial itself.
    constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
    const double tolerance = kSteps * tolerance_;
    equations_.ignore_weak_rows(std::min(kRounding / tolerance, 0.1), tolerance * scales_.length);
  }
  project(time, out);
  equations_.ignore_weak_rows(0, 0);
}

void EventFreeIntegrator::truncate(double time) {
  if (y_.size() > 0 && is_ballistic()) {
    ballistic_step(time);
  } else if (y_.size() > 0 && last_implicit_) {
    implicit_.forget();
    const bool found =
        implicit_.step(stiff_motion_, start_, time - start_, y0_.value(), rate_at_start(), all_.error_scale);
    if (!found) throw_step_underflow();
    apply_increment(time);
  } else if (y_.size() > 0) {
    current().method.step(flow_of_last(), start_, time - start_, coordinates_of(y0_));
    apply_increment(time);
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
  if (equations_.has_active_constraints()) {
    stiff_ = false;
  } else if (method_ == MotionMethod::Implicit) {
    stiff_ = true;
  }
}

void EventFreeIntegrator::pass_switch() {
  equations_.set_window(time_, time_);
  project(time_, y_);
  restart();
}

void EventFreeIntegrator::reset() {
  equations_.apply_hinge_impulses(time_, y_);
  project(time_, y_);
  control_.reset();
  proposed_step_ = 0;
  restart();
}

double EventFreeIntegrator::next_switch() const {
  const auto next = std::upper_bound(switches_.begin(), switches_.end(), time_);
  return next == switches_.end() ? equations_.next_switch() : std::min(*next, equations_.next_switch());
}

}  // namespace plumb::precise
