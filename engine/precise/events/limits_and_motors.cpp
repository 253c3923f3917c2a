#include "engine/precise/events/limits_and_motors.h"

#include <algorithm>
#include <cmath>

namespace plumb::precise {
namespace {

/// A force counts as an event if it exceeds its bound by this fraction of the largest force.
constexpr double kExcessNoise = 3e-11;
/// Rates below this fraction of the scene's speed are rounding.
constexpr double kRateTolerance = 1e-12;
/// Fraction of the scene's length, or of a radian: smaller gaps count as zero.
constexpr double kGapTolerance = 1e-13;

}  // namespace

LimitsAndMotors::LimitsAndMotors(const Scene& scene, const ScenePartition& partition,
                                 EquationsOfMotion& equations)
    : equations_(equations),
      length_(scales_of(scene, partition).length),
      speed_(scales_of(scene, partition).speed),
      modes_(equations.general_joints().limits_and_motors().size(), Mode::Free),
      sample_(equations.dimension()) {}

void LimitsAndMotors::find_reached_limits(double time, std::span<const double> y, const ContactFinder& finder,
                                          std::span<const BodyState> states,
                                          std::vector<ContactCandidate>& candidates) {
  if (empty()) return;
  const std::span<const Row<double>> rows = equations_.limit_motor_rows(time, y);
  rows_.assign(rows.begin(), rows.end());
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    const bool is_reached =
        rows_[k].residual <= 8 * kGapTolerance * std::max(length_, 1.0) || reached_limit_ == k;
    if (definition(k).role != RowRole::Limit || !is_reached) continue;
    ContactCandidate candidate;
    candidate.limit = k;
    candidate.count = 1;
    candidate.rows[0].normal = rows_[k];
    candidate.rows[0].tangent = {.a = rows_[k].a, .b = rows_[k].b};
    finder.update_rates(states, candidate);
    candidates.push_back(candidate);
  }
}

/// Returns by how much a motor's speed falls short of its target.
double LimitsAndMotors::speed_error(std::size_t k, double time, std::span<const Twist<double>> twists) const {
  return definition(k).speed_at(equations_.formula_time(time)).value - rate_along(rows_[k], twists);
}

std::vector<MotorAtSpeed> LimitsAndMotors::update_motors(double time, std::span<const double> y,
                                                         std::span<const BodyState> states,
                                                         std::vector<ContactCandidate>& candidates) {
  if (empty()) return {};
  const std::span<const Row<double>> rows = equations_.limit_motor_rows(time, y);
  rows_.assign(rows.begin(), rows.end());
  for (ContactCandidate& candidate : candidates) {
    if (candidate.limit) candidate.rows[0].normal = rows_[*candidate.limit];
  }
  twists_.clear();
  for (const BodyState& s : states) twists_.push_back({s.velocity, s.angular_velocity});
  std::vector<MotorAtSpeed> motors;
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    modes_[k] = Mode::Free;
    if (definition(k).role != RowRole::Motor) continue;
    const double error = speed_error(k, time, twists_);
    if (std::abs(error) <=
        8 * kRateTolerance *
            std::max(speed_, std::abs(definition(k).speed_at(equations_.formula_time(time)).value))) {
      motors.push_back({k, rows_[k], definition(k).max_force});
    } else {
      modes_[k] = error > 0 ? Mode::Forward : Mode::Backward;
    }
  }
  equations_.set_limit_motor_modes(modes_);
  return motors;
}

void LimitsAndMotors::release() {
  std::fill(modes_.begin(), modes_.end(), Mode::Free);
  reached_limit_.reset();
  if (!empty()) equations_.set_limit_motor_modes(modes_);
}

void LimitsAndMotors::activate_limit(std::size_t limit) { modes_[limit] = Mode::Held; }

void LimitsAndMotors::set_motor_mode(const MotorAtSpeed& motor, int mode) {
  modes_[motor.index] = mode == 0 ? Mode::Held : mode > 0 ? Mode::Backward : Mode::Forward;
}

void LimitsAndMotors::apply_modes(double force) {
  if (empty()) return;
  force_scale_ = force;
  reached_limit_.reset();
  equations_.set_limit_motor_modes(modes_);
}

bool LimitsAndMotors::is_free_limit(std::size_t k) const {
  return modes_[k] == Mode::Free && definition(k).role == RowRole::Limit;
}

double LimitsAndMotors::tolerance(std::size_t k) const {
  const bool limit = definition(k).role == RowRole::Limit;
  if (modes_[k] == Mode::Held)
    return kExcessNoise * (limit ? force_scale_ : std::max(force_scale_, definition(k).max_force)) + 1e-300;
  return limit ? kGapTolerance * std::max(length_, 1.0) : 0.25 * kRateTolerance * speed_;
}

void LimitsAndMotors::evaluate(double time, std::span<const double> y, std::span<double> values) {
  std::span<const double> force;
  if (equations_.has_active_constraints()) force = equations_.contact_forces(time, y).limit_motor;
  const std::span<const Row<double>> rows = equations_.has_active_constraints()
                                                ? equations_.limit_motor_rows()
                                                : equations_.limit_motor_rows(time, y);
  std::size_t held = 0;
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    const bool limit = definition(k).role == RowRole::Limit;
    if (modes_[k] == Mode::Held) {
      const double f = force[held++];
      values[k] = limit ? f : definition(k).max_force - std::abs(f);
    } else if (limit) {
      values[k] = rows[k].residual;
    } else {
      const double error = definition(k).speed_at(equations_.formula_time(time)).value -
                           rate_along(rows[k], equations_.twists());
      values[k] = modes_[k] == Mode::Forward ? error : -error;
    }
  }
}

LimitsAndMotors::LimitGap LimitsAndMotors::gap_of_limit(std::size_t limit, double time,
                                                        std::span<const double> y) {
  const Row<double>& row = equations_.limit_motor_rows(time, y)[limit];
  return {row.residual, rate_along(row, equations_.twists())};
}

/// Returns a duration from `time` on during which a limit is certainly not reached.
double LimitsAndMotors::safe_step(std::size_t k, const LimitGap& now, const StepMotionBounds& bounds,
                                  double time, double until) const {
  const GeneralJoints::LimitOrMotor& s = definition(k);
  const StepMotionBounds::RotationBounds rotation_a = bounds.rotation_bounds_of(s.a),
                                         rotation_b = bounds.rotation_bounds_of(s.b);
  const double f = now.gap + tolerance(k);
  if (s.kind == GeneralJoints::LimitOrMotor::Kind::Angle)
    return time_above_zero(f, now.rate, rotation_a.acceleration + rotation_b.acceleration);
  const auto length = [](Vec2d v) { return std::sqrt(length_squared(v)); };
  const auto rotation_bound = [](const StepMotionBounds::RotationBounds& rotation) {
    return rotation.acceleration + rotation.speed * rotation.speed;
  };
  const StepMotionBounds::Relative relative = bounds.relative_of(s.a, s.b);
  const StepMotionBounds::BodyMotion a = bounds.motion_of(s.a, time), b = bounds.motion_of(s.b, time);
  const double arm_a = length(s.anchor_a), arm_b = length(s.anchor_b);
  const double apart = length((b.pose.position + b.pose.rotation * s.anchor_b) -
                              (a.pose.position + a.pose.rotation * s.anchor_a));
  const double speed = relative.speed + rotation_a.speed * arm_a + rotation_b.speed * arm_b;
  const double acceleration =
      relative.acceleration + rotation_bound(rotation_a) * arm_a + rotation_bound(rotation_b) * arm_b;
  if (s.kind == GeneralJoints::LimitOrMotor::Kind::Translation) {
    // C = n . d, n turning with a: C'' = n . d'' + 2 w t . d' + (dw/dt) t . d - w^2 n . d.
    const double distance = apart + (until - time) * speed;
    return time_above_zero(
        f, now.rate, acceleration + 2 * rotation_a.speed * speed + rotation_bound(rotation_a) * distance);
  }
  // |d|'' is at most |d''| + |d'|^2 / |d|, as long as |d| is at least half of its present value.
  if (!(speed > 0)) return until - time;
  const double half = apart / (2 * speed);
  const double curved =
      apart > 0 ? time_above_zero(f, now.rate, acceleration + 2 * speed * speed / apart) : 0;
  return std::max(f / speed, std::min(curved, half));
}

std::optional<double> LimitsAndMotors::first_reached_time(std::size_t k, const StepMotionBounds& bounds,
                                                          EventFreeIntegrator& integrator, double until) {
  constexpr double kShortest = 1.0 / 4096;
  const double start = integrator.start(), h = integrator.time() - start,
               tolerance_at_limit = 1e-3 * tolerance(k);
  const auto evaluate_at = [&](double time) {
    integrator.at(time, false, sample_);
    return gap_of_limit(k, time, sample_.value());
  };
  double time = start;
  LimitGap now = evaluate_at(time);
  // If the limit is reached at the start and opens, or is about to, begin at the time when it is open.
  const double deepest = std::min(now.gap, 0.0) - tolerance(k);
  for (double fraction = 1e-8; now.gap + tolerance(k) <= tolerance_at_limit && time < until; fraction *= 4) {
    time = std::min(start + fraction * h, until);
    now = evaluate_at(time);
    if (now.gap < deepest) return time;
  }
  while (time < until) {
    if (now.gap + tolerance(k) <= tolerance_at_limit) return time;
    time = std::min(time + std::max(safe_step(k, now, bounds, time, until), kShortest * h), until);
    now = evaluate_at(time);
  }
  return now.gap + tolerance(k) <= tolerance_at_limit ? std::optional(until) : std::nullopt;
}

std::optional<LimitsAndMotors::ReachedLimit> LimitsAndMotors::first_reached(const StepMotionBounds& bounds,
                                                                            EventFreeIntegrator& integrator,
                                                                            double until) {
  std::optional<ReachedLimit> first;
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    if (!is_free_limit(k)) continue;
    const auto time = first_reached_time(k, bounds, integrator, until);
    if (!time) continue;
    until = *time;
    first = ReachedLimit{until, k};
  }
  return first;
}

void LimitsAndMotors::copy_modes(const LimitsAndMotors& other) {
  modes_ = other.modes_;
  force_scale_ = other.force_scale_;
  if (!empty()) equations_.set_limit_motor_modes(modes_);
}

void LimitsAndMotors::save(SnapshotWriter& out) const {
  for (const Mode mode : modes_) out.put(static_cast<std::int64_t>(mode));
  out.put(reached_limit_ ? static_cast<std::int64_t>(*reached_limit_) : std::int64_t{-1});
  out.put(force_scale_);
}

void LimitsAndMotors::restore(SnapshotReader& in) {
  for (Mode& mode : modes_) {
    const auto value = in.get<std::int64_t>();
    in.expect(value >= 0 && value <= static_cast<std::int64_t>(Mode::Backward));
    mode = static_cast<Mode>(value);
  }
  const auto met = in.get<std::int64_t>();
  in.expect(met >= -1 && met < static_cast<std::int64_t>(modes_.size()));
  reached_limit_ = met < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(met));
  force_scale_ = in.get<double>();
  equations_.set_limit_motor_modes(modes_);
}

}  // namespace plumb::precise
