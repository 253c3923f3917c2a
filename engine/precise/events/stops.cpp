#include "engine/precise/events/stops.h"

#include <algorithm>
#include <cmath>

namespace plumb::precise {
namespace {

/// A force counts as an event if it exceeds its bound by this fraction of the largest force.
constexpr double kExcessNoise = 3e-11;
/// Rates below this fraction of the scene's speed are rounding.
constexpr double kQuiet = 1e-12;
/// Fraction of the scene's length, or of a radian: smaller gaps count as zero.
constexpr double kNear = 1e-13;

}  // namespace

Stops::Stops(const Scene& scene, const Parts& parts, EquationsOfMotion& equations)
    : equations_(equations),
      length_(scales_of(scene, parts).length),
      speed_(scales_of(scene, parts).speed),
      modes_(equations.kind_joints().stops().size(), Mode::Free),
      sample_(equations.dimension()) {}

void Stops::find(double time, std::span<const double> y, const TouchFinder& finder,
                 std::span<const BodyState> states, std::vector<ContactCandidate>& touches) {
  if (empty()) return;
  const std::span<const Row<double>> rows = equations_.stop_rows(time, y);
  rows_.assign(rows.begin(), rows.end());
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    const bool at_end = rows_[k].residual <= 8 * kNear * std::max(length_, 1.0) || met_ == k;
    if (stop(k).role != RowRole::Limit || !at_end) continue;
    ContactCandidate touch;
    touch.stop = k;
    touch.count = 1;
    touch.rows[0].normal = rows_[k];
    touch.rows[0].tangent = {.a = rows_[k].a, .b = rows_[k].b};
    finder.measure(states, touch);
    touches.push_back(touch);
  }
}

/// Returns by how much a motor's speed falls short of its target.
double Stops::lacking(std::size_t k, double time, std::span<const Twist<double>> twists) const {
  return stop(k).speed_at(time).value - rate_along(rows_[k], twists);
}

std::vector<Brake> Stops::push(double time, std::span<const double> y, std::span<const BodyState> states,
                               std::vector<ContactCandidate>& touches) {
  if (empty()) return {};
  const std::span<const Row<double>> rows = equations_.stop_rows(time, y);
  rows_.assign(rows.begin(), rows.end());
  for (ContactCandidate& touch : touches) {
    if (touch.stop) touch.rows[0].normal = rows_[*touch.stop];
  }
  twists_.clear();
  for (const BodyState& s : states) twists_.push_back({s.velocity, s.angular_velocity});
  std::vector<Brake> brakes;
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    modes_[k] = Mode::Free;
    if (stop(k).role != RowRole::Motor) continue;
    const double slow = lacking(k, time, twists_);
    if (std::abs(slow) <= 8 * kQuiet * std::max(speed_, std::abs(stop(k).speed_at(time).value))) {
      brakes.push_back({k, rows_[k], stop(k).max_force});
    } else {
      modes_[k] = slow > 0 ? Mode::Forward : Mode::Backward;
    }
  }
  equations_.hold_stops(modes_);
  return brakes;
}

void Stops::let_go() {
  std::fill(modes_.begin(), modes_.end(), Mode::Free);
  met_.reset();
  if (!empty()) equations_.hold_stops(modes_);
}

void Stops::hold(std::size_t limit) { modes_[limit] = Mode::Held; }

void Stops::take(const Brake& brake, int mode) {
  modes_[brake.stop] = mode == 0 ? Mode::Held : mode > 0 ? Mode::Backward : Mode::Forward;
}

void Stops::act(double force) {
  if (empty()) return;
  force_scale_ = force;
  met_.reset();
  equations_.hold_stops(modes_);
}

bool Stops::is_free_limit(std::size_t k) const {
  return modes_[k] == Mode::Free && stop(k).role == RowRole::Limit;
}

double Stops::tolerance(std::size_t k) const {
  const bool limit = stop(k).role == RowRole::Limit;
  if (modes_[k] == Mode::Held)
    return kExcessNoise * (limit ? force_scale_ : std::max(force_scale_, stop(k).max_force)) + 1e-300;
  return limit ? kNear * std::max(length_, 1.0) : 0.25 * kQuiet * speed_;
}

void Stops::evaluate(double time, std::span<const double> y, std::span<double> values) {
  std::span<const double> force;
  if (equations_.holds_anything()) force = equations_.contact_forces(time, y).stop;
  const std::span<const Row<double>> rows =
      equations_.holds_anything() ? equations_.stop_rows() : equations_.stop_rows(time, y);
  std::size_t held = 0;
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    const bool limit = stop(k).role == RowRole::Limit;
    if (modes_[k] == Mode::Held) {
      const double f = force[held++];
      values[k] = limit ? f : stop(k).max_force - std::abs(f);
    } else if (limit) {
      values[k] = rows[k].residual;
    } else {
      const double slow = stop(k).speed_at(time).value - rate_along(rows[k], equations_.twists());
      values[k] = modes_[k] == Mode::Forward ? slow : -slow;
    }
  }
}

Stops::Approach Stops::approach(std::size_t limit, double time, std::span<const double> y) {
  const Row<double>& row = equations_.stop_rows(time, y)[limit];
  return {row.residual, rate_along(row, equations_.twists())};
}

/// Returns a duration from `time` on during which a limit is certainly not reached.
double Stops::safe_step(std::size_t k, const Approach& now, const StepMotionBounds& paths, double time,
                        double until) const {
  const GeneralJoints::Stop& s = stop(k);
  const StepMotionBounds::Turning turn_a = paths.turning_of(s.a), turn_b = paths.turning_of(s.b);
  const double f = now.gap + tolerance(k);
  if (s.kind == GeneralJoints::Stop::Kind::Turn)
    return lasts(f, now.rate, turn_a.acceleration + turn_b.acceleration);
  const auto length = [](Vec2d v) { return std::sqrt(length_squared(v)); };
  const auto swing = [](const StepMotionBounds::Turning& turn) {
    return turn.acceleration + turn.speed * turn.speed;
  };
  const StepMotionBounds::Relative relative = paths.relative_of(s.a, s.b);
  const StepMotionBounds::Placed a = paths.placed(s.a, time), b = paths.placed(s.b, time);
  const double reach_a = length(s.anchor_a), reach_b = length(s.anchor_b);
  const double apart = length((b.pose.position + b.pose.rotation * s.anchor_b) -
                              (a.pose.position + a.pose.rotation * s.anchor_a));
  const double speed = relative.speed + turn_a.speed * reach_a + turn_b.speed * reach_b;
  const double acceleration = relative.acceleration + swing(turn_a) * reach_a + swing(turn_b) * reach_b;
  if (s.kind == GeneralJoints::Stop::Kind::Line) {
    // C = n . d, n turning with a: C'' = n . d'' + 2 w t . d' + (dw/dt) t . d - w^2 n . d.
    const double far = apart + (until - time) * speed;
    return lasts(f, now.rate, acceleration + 2 * turn_a.speed * speed + swing(turn_a) * far);
  }
  // |d|'' is at most |d''| + |d'|^2 / |d|, as long as |d| is at least half of its present value.
  if (!(speed > 0)) return until - time;
  const double half = apart / (2 * speed);
  const double bent = apart > 0 ? lasts(f, now.rate, acceleration + 2 * speed * speed / apart) : 0;
  return std::max(f / speed, std::min(bent, half));
}

std::optional<double> Stops::first_time(std::size_t k, const StepMotionBounds& paths,
                                        EventFreeIntegrator& smooth, double until) {
  constexpr double kShortest = 1.0 / 4096;
  const double start = smooth.start(), h = smooth.time() - start, there = 1e-3 * tolerance(k);
  const auto look = [&](double time) {
    smooth.at(time, false, sample_);
    return approach(k, time, sample_.value());
  };
  double time = start;
  Approach now = look(time);
  // If the limit is reached at the start and opens, or is about to, begin at the time when it is open.
  const double deepest = std::min(now.gap, 0.0) - tolerance(k);
  for (double share = 1e-8; now.gap + tolerance(k) <= there && time < until; share *= 4) {
    time = std::min(start + share * h, until);
    now = look(time);
    if (now.gap < deepest) return time;
  }
  while (time < until) {
    if (now.gap + tolerance(k) <= there) return time;
    time = std::min(time + std::max(safe_step(k, now, paths, time, until), kShortest * h), until);
    now = look(time);
  }
  return now.gap + tolerance(k) <= there ? std::optional(until) : std::nullopt;
}

std::optional<Stops::ReachedLimit> Stops::first_reached(const StepMotionBounds& paths,
                                                        EventFreeIntegrator& smooth, double until) {
  std::optional<ReachedLimit> first;
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    if (!is_free_limit(k)) continue;
    const auto time = first_time(k, paths, smooth, until);
    if (!time) continue;
    until = *time;
    first = ReachedLimit{until, k};
  }
  return first;
}

void Stops::follow(const Stops& other) {
  modes_ = other.modes_;
  force_scale_ = other.force_scale_;
  if (!empty()) equations_.hold_stops(modes_);
}

void Stops::save(SnapshotWriter& out) const {
  for (const Mode mode : modes_) out.put(static_cast<std::int64_t>(mode));
  out.put(met_ ? static_cast<std::int64_t>(*met_) : std::int64_t{-1});
  out.put(force_scale_);
}

void Stops::restore(SnapshotReader& in) {
  for (Mode& mode : modes_) {
    const auto value = in.get<std::int64_t>();
    in.expect(value >= 0 && value <= static_cast<std::int64_t>(Mode::Backward));
    mode = static_cast<Mode>(value);
  }
  const auto met = in.get<std::int64_t>();
  in.expect(met >= -1 && met < static_cast<std::int64_t>(modes_.size()));
  met_ = met < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(met));
  force_scale_ = in.get<double>();
  equations_.hold_stops(modes_);
}

}  // namespace plumb::precise
