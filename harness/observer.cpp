#include "harness/observer.h"
#include "harness/magnitude.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace plumb::harness {
namespace {

bool finite(const BodyState& s) {
  return std::isfinite(s.position.x) && std::isfinite(s.position.y) && std::isfinite(s.angle) &&
         std::isfinite(s.velocity.x) && std::isfinite(s.velocity.y) && std::isfinite(s.angular_velocity);
}

// Raises `largest` to `value`. NaN counts as larger than any number, and stays.
void raise(std::optional<double>& largest, double value) {
  if (!largest || std::isnan(value) || value > *largest) largest = value;
}

void hold(WorstRatio& check, double value, const Tolerances::Bound& bound) {
  if (bound) check.add(value, *bound);
}

}  // namespace

Observer::Observer(const Case& scene_case, const reference::Method& method,
                   const reference::StepSettings& settings, Track* track)
    : case_(scene_case),
      method_(method),
      scale_(conservation_scale(scene_case.problem.scene, scene_case.truth)),
      tolerances_(scene_case.problem, scene_case.truth, method, settings, scale_),
      drifts_(scene_case.problem, scale_),
      joints_(scene_case.problem.scene),
      penetration_(scene_case.problem.scene),
      track_(track),
      discrete_(scene_case.problem.scene.bodies.size()),
      discrete_known_(static_cast<bool>(scene_case.problem.truth.discrete) && method.order != 0),
      derived_(scene_case.problem.expected.empty()),
      expected_(scene_case.problem.expected.size()),
      times_done_(scene_case.problem.expected.size(), 0) {}

void Observer::add(int sample, std::span<const BodyState> states) {
  if (!diverged()) watch_for_divergence(sample, states);
  if (diverged()) return;
  if (case_.truth.known()) against_truth(sample, states);
  against_discrete(sample, states);
  invariants(sample, states);
  against_expected(sample, states);
  follow(sample, states);
}

void Observer::watch_for_divergence(int sample, std::span<const BodyState> states) {
  const double allowed = kDiverged * case_.truth.scale().extent;
  const double start = case_.truth.scale().length;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const std::string& name = case_.problem.scene.bodies[i].name;
    const double time = sample * case_.truth.dt();
    if (!finite(states[i])) {
      why_diverged_ = fmt::format("the state of body '{}' is not finite at t = {:.6g} s", name, time);
      finite_.add(INFINITY, 1);
      return;
    }
    const Vec2d from = case_.truth.known() ? case_.truth.at(sample)[i].position : Vec2d{};
    const double off = magnitude(states[i].position - from) - (case_.truth.known() ? 0 : start);
    finite_.add(std::max(off, 0.0), allowed);
    if (off > allowed) {
      why_diverged_ = fmt::format("body '{}' is {:.3g} m off at t = {:.6g} s", name, off, time);
      return;
    }
  }
}

bool Observer::near_impact(double time) const {
  const double dt = case_.truth.dt();
  const auto& impacts = case_.problem.truth.impacts;
  return std::any_of(impacts.begin(), impacts.end(),
                     [&](double impact) { return std::abs(time - impact) <= dt * (1 + 1e-9); });
}

void Observer::against_truth(int sample, std::span<const BodyState> states) {
  const auto truth = case_.truth.at(sample);
  const bool quiet = !near_impact(sample * case_.truth.dt());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double position = magnitude(states[i].position - truth[i].position);
    const double angle = std::abs(states[i].angle - truth[i].angle);
    raise(metrics_.position_error, position);
    raise(metrics_.angle_error, angle);
    hold(position_, position, tolerances_.position(sample, i));
    hold(angle_, angle, tolerances_.angle(sample, i));
    if (!quiet) continue;
    const double velocity = magnitude(states[i].velocity - truth[i].velocity);
    const double angular = std::abs(states[i].angular_velocity - truth[i].angular_velocity);
    raise(metrics_.velocity_error, velocity);
    raise(metrics_.angular_velocity_error, angular);
    hold(velocity_, velocity, tolerances_.velocity(sample, i));
    hold(angular_velocity_, angular, tolerances_.angular_velocity(sample, i));
  }
}

void Observer::against_discrete(int sample, std::span<const BodyState> states) {
  if (!discrete_known_) return;
  const long steps = std::lround(sample * case_.truth.dt() / method_.substep);
  std::vector<BodyState> expected(states.begin(), states.end());
  discrete_known_ = case_.problem.truth.discrete(method_.scheme, method_.substep, steps, expected);
  if (!discrete_known_) return;
  const StateBound rounding = tolerances_.rounding(sample);
  for (std::size_t i = 0; i < states.size(); ++i) {
    discrete_position_.add(magnitude(states[i].position - expected[i].position), rounding.position);
    discrete_angle_.add(std::abs(states[i].angle - expected[i].angle), rounding.angle);
    discrete_velocity_.add(magnitude(states[i].velocity - expected[i].velocity), rounding.velocity);
    discrete_angular_velocity_.add(std::abs(states[i].angular_velocity - expected[i].angular_velocity),
                                   rounding.angular_velocity);
  }
}

void Observer::invariants(int sample, std::span<const BodyState> states) {
  const Drift drift = drifts_.drift(states);
  if (drift.energy)
    raise(metrics_.energy_drift, *drift.energy), hold(energy_, *drift.energy, tolerances_.energy(sample));
  if (drift.momentum) {
    raise(metrics_.momentum_drift, *drift.momentum);
    hold(momentum_, *drift.momentum, tolerances_.momentum(sample));
  }
  if (drift.angular_momentum) {
    raise(metrics_.angular_momentum_drift, *drift.angular_momentum);
    hold(angular_momentum_, *drift.angular_momentum, tolerances_.angular_momentum(sample));
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const double gap = joints_.gap(j, states);
    raise(metrics_.joint_gap, gap);
    hold(gap_, gap, tolerances_.joint_gap(sample, joints_, j));
  }
  if (penetration_.possible()) {
    const double depth = penetration_.deepest(states);
    raise(metrics_.penetration, depth);
    hold(depth_, depth, tolerances_.penetration(sample));
  }
}

void Observer::expect_at(std::size_t index, double time, std::span<const BodyState> states) {
  const scenarios::Expectation::Miss miss = case_.problem.expected[index].miss(time, states);
  expected_[index].add(miss.value, miss.tolerance);
}

namespace {

// Interpolates between two samples by the cubic through both positions and velocities, at the fraction `part`
// of `span` seconds. Its error is of fourth order in the step, less than the error of any engine's steps.
// Across an impact it is up to the jump times the span.
double between(double a, double va, double b, double vb, double span, double part, double& rate) {
  const double p = part, q = p * p;
  const double slope = b - a - span * va, bend = span * (va + vb) - 2 * (b - a);
  rate = span > 0 ? va + (2 * p * (slope - bend) + 3 * q * bend) / span : va;
  return a + p * span * va + q * (slope - bend) + q * p * bend;
}

BodyState between(const BodyState& a, const BodyState& b, double span, double part) {
  BodyState out;
  out.position.x =
      between(a.position.x, a.velocity.x, b.position.x, b.velocity.x, span, part, out.velocity.x);
  out.position.y =
      between(a.position.y, a.velocity.y, b.position.y, b.velocity.y, span, part, out.velocity.y);
  out.angle =
      between(a.angle, a.angular_velocity, b.angle, b.angular_velocity, span, part, out.angular_velocity);
  return out;
}

}  // namespace

// Drifts are relative to the largest value of the truth or, if there is none, of the whole run. So a run
// without a truth whose energy grows without bound has a drift of 1, above any useful tolerance.
double Observer::measured(scenarios::Expectation::Law law) const {
  using Law = scenarios::Expectation::Law;
  const auto relative = [&](const std::optional<double>& drift, double scale, double largest) {
    if (!drift || case_.truth.known() || *drift == 0) return drift.value_or(NAN);
    return *drift * scale / largest;
  };
  switch (law) {
    case Law::Energy:
      return relative(metrics_.energy_drift, scale_.energy, largest_.kinetic);
    case Law::Momentum:
      return relative(metrics_.momentum_drift, scale_.momentum, largest_.sum_of_momenta);
    case Law::AngularMomentum:
      return relative(metrics_.angular_momentum_drift, scale_.angular_momentum,
                      largest_.sum_of_angular_momenta);
    case Law::Joints:
      return metrics_.joint_gap.value_or(0);
    case Law::NoOverlap:
      return metrics_.penetration.value_or(0);
    case Law::None:
      break;
  }
  return NAN;
}

void Observer::against_expected(int sample, std::span<const BodyState> states) {
  const double dt = case_.truth.dt(), now = sample * dt, slack = 1e-9 * dt;
  std::vector<BodyState> at;
  for (std::size_t i = 0; i < expected_.size(); ++i) {
    const scenarios::Expectation& expectation = case_.problem.expected[i];
    if (expectation.law != scenarios::Expectation::Law::None) continue;  // known at the end
    if (expectation.times.empty()) {
      if (now >= expectation.from - slack && now <= expectation.until + slack) expect_at(i, now, states);
    } else {
      for (std::size_t& k = times_done_[i]; k < expectation.times.size(); ++k) {
        const double time = expectation.times[k];
        if (time > now + slack) break;
        if (time >= now - slack || before_.empty()) {
          expect_at(i, time, states);
          continue;
        }
        at.resize(states.size());
        for (std::size_t body = 0; body < states.size(); ++body)
          at[body] = between(before_[body], states[body], dt, (time - (now - dt)) / dt);
        expect_at(i, time, at);
      }
    }
  }
  if (expected_.empty()) return;
  before_.assign(states.begin(), states.end());
  const Mechanics sums = mechanics(case_.problem.scene, states);
  largest_.kinetic = std::max(largest_.kinetic, sums.kinetic);
  largest_.sum_of_momenta = std::max(largest_.sum_of_momenta, sums.sum_of_momenta);
  largest_.sum_of_angular_momenta = std::max(largest_.sum_of_angular_momenta, sums.sum_of_angular_momenta);
}

// A time that no step of the run reached counts as a miss.
void Observer::finish_expected(Result& result) const {
  std::optional<double> ratio;
  for (std::size_t i = 0; i < expected_.size(); ++i) {
    const scenarios::Expectation& expectation = case_.problem.expected[i];
    WorstRatio worst = expected_[i];
    if (expectation.law != scenarios::Expectation::Law::None)
      worst.add(measured(expectation.law), expectation.tolerance);
    if (!worst.any() || times_done_[i] < expectation.times.size()) worst.add(NAN, expectation.tolerance);
    const bool law = expectation.law != scenarios::Expectation::Law::None;
    const Check check = worst.check("expected " + expectation.name, law ? Oracle::Invariant : Oracle::Exact);
    raise(ratio, check.pass && check.value <= 0 ? 0 : check.value / check.tolerance);
    result.checks.push_back(check);
  }
  result.metrics.expected_miss = ratio;
}

void Observer::follow(int sample, std::span<const BodyState> states) {
  if (track_ == nullptr || !track_->keeps(sample)) return;
  for (std::size_t i = 0; i < states.size(); ++i) {
    track_->put(sample, i,
                {states[i].position.x, states[i].position.y, states[i].angle,
                 tolerances_.position(sample, i).value_or(-1), tolerances_.angle(sample, i).value_or(-1)});
  }
}

void Observer::finish(Result& result) const {
  result.metrics = metrics_;
  if (diverged()) {
    result.status = Status::Diverged;
    result.reason = why_diverged_;
  }
  const auto put = [&](const char* name, Oracle oracle, const WorstRatio& worst) {
    if (worst.any()) result.checks.push_back(worst.check(name, oracle));
  };
  put("finite", Oracle::Invariant, finite_);
  if (diverged()) return;  // figures of a partial run would mislead
  finish_expected(result);
  if (!derived_) return;
  put("position_error", Oracle::Exact, position_);
  put("angle_error", Oracle::Exact, angle_);
  put("velocity_error", Oracle::Exact, velocity_);
  put("angular_velocity_error", Oracle::Exact, angular_velocity_);
  if (discrete_known_) {
    put("discrete_position", Oracle::Discrete, discrete_position_);
    put("discrete_angle", Oracle::Discrete, discrete_angle_);
    put("discrete_velocity", Oracle::Discrete, discrete_velocity_);
    put("discrete_angular_velocity", Oracle::Discrete, discrete_angular_velocity_);
  }
  put("energy_drift", Oracle::Invariant, energy_);
  put("momentum_drift", Oracle::Invariant, momentum_);
  put("angular_momentum_drift", Oracle::Invariant, angular_momentum_);
  put("joint_gap", Oracle::Invariant, gap_);
  put("penetration", Oracle::Invariant, depth_);
}

}  // namespace plumb::harness
