#include "engine/simulation/precise_stops.h"

#include <algorithm>
#include <cmath>

namespace plumb::precise {
namespace {

/// Forces may be this much beyond their bound before it counts, of the largest of them.
constexpr double kForceNoise = 3e-11;
/// Of the scene's speed: what rounding can make of a rate.
constexpr double kQuiet = 1e-12;
/// Of the scene's length, or of a radian: what is no gap.
constexpr double kNear = 1e-13;

}  // namespace

Stops::Stops(const Scene& scene, const Parts& parts, EquationsOfMotion& equations)
    : equations_(equations),
      length_(scales_of(scene, parts).length),
      speed_(scales_of(scene, parts).speed),
      modes_(equations.kind_joints().stops().size(), Mode::Free) {}

void Stops::find(double time, std::span<const double> y, const TouchFinder& finder,
                 std::span<const BodyState> states, std::vector<Touch>& touches) {
  if (empty()) return;
  const std::span<const Row<double>> rows = equations_.stop_rows(time, y);
  rows_.assign(rows.begin(), rows.end());
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    const bool at_end = rows_[k].residual <= 8 * kNear * std::max(length_, 1.0) || met_ == k;
    if (stop(k).role != RowRole::Limit || !at_end) continue;
    Touch touch;
    touch.stop = k;
    touch.count = 1;
    touch.rows[0].normal = rows_[k];
    touch.rows[0].tangent = {.a = rows_[k].a, .b = rows_[k].b};
    finder.measure(states, touch);
    touches.push_back(touch);
  }
}

/// How much a motor is too slow.
double Stops::lacking(std::size_t k, std::span<const Twist<double>> twists) const {
  return stop(k).speed - rate_along(rows_[k], twists);
}

std::vector<Brake> Stops::push(double time, std::span<const double> y, std::span<const BodyState> states,
                               std::vector<Touch>& touches) {
  if (empty()) return {};
  const std::span<const Row<double>> rows = equations_.stop_rows(time, y);
  rows_.assign(rows.begin(), rows.end());
  for (Touch& touch : touches) {
    if (touch.stop) touch.rows[0].normal = rows_[*touch.stop];
  }
  twists_.clear();
  for (const BodyState& s : states) twists_.push_back({s.velocity, s.angular_velocity});
  std::vector<Brake> brakes;
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    modes_[k] = Mode::Free;
    if (stop(k).role != RowRole::Motor) continue;
    const double slow = lacking(k, twists_);
    if (std::abs(slow) <= 8 * kQuiet * std::max(speed_, std::abs(stop(k).speed))) {
      brakes.push_back({k, rows_[k], stop(k).max_force});
    } else {
      modes_[k] = slow > 0 ? Mode::Forward : Mode::Backward;
    }
  }
  equations_.hold_stops(modes_);
  return brakes;
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
    return kForceNoise * (limit ? force_scale_ : std::max(force_scale_, stop(k).max_force)) + 1e-300;
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
      const double slow = stop(k).speed - rate_along(rows[k], equations_.twists());
      values[k] = modes_[k] == Mode::Forward ? slow : -slow;
    }
  }
}

Stops::Approach Stops::approach(std::size_t limit, double time, std::span<const double> y) {
  const Row<double>& row = equations_.stop_rows(time, y)[limit];
  return {row.residual, rate_along(row, equations_.twists())};
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
