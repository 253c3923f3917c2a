#include "harness/observer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace plumb::harness {
namespace {

double magnitude(Vec2d v) { return std::hypot(v.x, v.y); }

bool finite(const BodyState& s) {
  return std::isfinite(s.position.x) && std::isfinite(s.position.y) && std::isfinite(s.angle) &&
         std::isfinite(s.velocity.x) && std::isfinite(s.velocity.y) && std::isfinite(s.angular_velocity);
}

// Raises `largest` to `value`. NaN counts as larger than all, and stays.
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
      discrete_known_(static_cast<bool>(scene_case.problem.truth.discrete) && method.order != 0) {}

void Observer::add(int sample, std::span<const BodyState> states) {
  if (!diverged()) watch_for_divergence(sample, states);
  if (diverged()) return;
  if (case_.truth.known()) against_truth(sample, states);
  against_discrete(sample, states);
  invariants(sample, states);
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
