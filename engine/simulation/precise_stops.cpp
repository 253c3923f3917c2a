#include "engine/simulation/precise_stops.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/error.h"
#include "engine/scene/text.h"
#include "engine/simulation/precise_events.h"
#include "engine/solve/dense_system.h"

namespace plumb::precise {
namespace {

/// Samples of a step that limits and forces are watched at.
constexpr int kSamples = 5;
/// Forces may be this much beyond their bound before it counts, of the largest of them.
constexpr double kForceNoise = 3e-11;
/// Of the scene's speed: what rounding can make of a rate.
constexpr double kQuiet = 1e-12;
/// Of the scene's length, or of a radian: what is no gap.
constexpr double kNear = 1e-13;
constexpr int kMostEventsAtOnce = 500;

double along(const Row<double>& row, std::span<const Twist<double>> motion) {
  const auto part = [&](int body, Vec2d linear, double angular) {
    if (body == kFixedFrame) return 0.0;
    return dot(linear, motion[body].velocity) + angular * motion[body].angular_velocity;
  };
  return part(row.a, row.linear_a, row.angular_a) + part(row.b, row.linear_b, row.angular_b);
}

}  // namespace

Stops::Stops(const Scene& scene, const Parts& parts, EquationsOfMotion& equations, SmoothMotion& smooth)
    : equations_(equations),
      smooth_(smooth),
      count_(equations.kind_joints().stops().size()),
      length_(scales_of(scene, parts).length),
      speed_(scales_of(scene, parts).speed),
      modes_(count_, Mode::Free),
      tolerance_(count_),
      scratch_(equations.dimension()),
      sample_(equations.dimension()) {}

/// Rows and velocities where the motion is.
void Stops::look() {
  equations_.rate(smooth_.time(), smooth_.state().value(), scratch_);
  const std::span<const Row<double>> rows = equations_.stop_rows();
  rows_.assign(rows.begin(), rows.end());
  twists_.assign(equations_.twists().begin(), equations_.twists().end());
}

/// How fast a limit opens, or how much a motor is too fast.
double Stops::rate_of(std::size_t k) const {
  const KindJoints::Stop& stop = equations_.kind_joints().stops()[k];
  return along(rows_[k], twists_) - (stop.role == RowRole::Motor ? stop.speed : 0);
}

bool Stops::at_end(std::size_t k) const {
  return rows_[k].residual <= 8 * kNear * std::max(length_, 1.0) || met_ == k;
}

Stops::Problem Stops::problem(const std::vector<std::size_t>& stops) {
  Problem p;
  p.stops = stops;
  std::vector<Row<double>> rows;
  for (const std::size_t k : stops) {
    rows.push_back(rows_[k]);
    const KindJoints::Stop& stop = equations_.kind_joints().stops()[k];
    p.least.push_back(stop.role == RowRole::Motor ? -stop.max_force : 0);
    p.most.push_back(stop.role == RowRole::Motor ? stop.max_force : std::numeric_limits<double>::infinity());
  }
  equations_.respond(smooth_.time(), smooth_.state().value(), std::move(rows), p.response, p.matrix);
  return p;
}

/// Forces within their bounds, such that each rate is zero, or not negative at the least force, or not
/// positive at the most: least-index principal pivoting (K. G. Murty 1974).
std::vector<double> Stops::solve(const Problem& p, std::vector<Mode>& modes) const {
  constexpr int kMost = 10000;
  const std::size_t n = p.stops.size();
  modes.assign(n, Mode::Held);
  std::vector<double> force(n);
  for (int pivot = 0; pivot < kMost; ++pivot) {
    std::vector<std::size_t> held;
    for (std::size_t i = 0; i < n; ++i) {
      if (modes[i] == Mode::Held) held.push_back(i);
      force[i] = modes[i] == Mode::Backward || modes[i] == Mode::Free ? p.least[i]
                 : modes[i] == Mode::Forward                          ? p.most[i]
                                                                      : 0;
    }
    const auto rate = [&](std::size_t i) {
      double sum = p.rate[i];
      for (std::size_t j = 0; j < n; ++j) sum += p.matrix[i * n + j] * force[j];
      return sum;
    };
    std::vector<double> matrix, side;
    for (const std::size_t i : held) {
      for (const std::size_t j : held) matrix.push_back(p.matrix[i * n + j]);
      side.push_back(-rate(i));
    }
    DenseSystem system;
    system.factor(held.size(), matrix, 1e-11);
    system.solve_refined(side);
    for (std::size_t h = 0; h < held.size(); ++h) force[held[h]] = side[h];
    double largest = 0, fastest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      largest = std::max(largest, std::abs(force[i]));
      fastest = std::max(fastest, std::abs(p.rate[i]));
    }
    std::size_t wrong = n;
    Mode better = Mode::Held;
    for (std::size_t i = 0; i < n && wrong == n; ++i) {
      if (modes[i] == Mode::Held) {
        if (force[i] < p.least[i] - kForceNoise / 4 * largest) {
          wrong = i, better = p.least[i] == 0 && p.most[i] > 0 ? Mode::Free : Mode::Backward;
        } else if (force[i] > p.most[i] + kForceNoise / 4 * largest) {
          wrong = i, better = Mode::Forward;
        }
      } else if (modes[i] == Mode::Forward ? rate(i) > kForceNoise * fastest
                                           : rate(i) < -kForceNoise * fastest) {
        wrong = i;
      }
    }
    if (wrong == n) return force;
    modes[wrong] = better;
  }
  throw Error(Error::Kind::Run, "joints", "limits", std::to_string(n),
              "no set of limits and motors holds at this instant; 'plumb-world' may do");
}

/// Limits that are met with an approach take it away, all at once; motors give no impulse.
void Stops::strike() {
  std::vector<std::size_t> ends;
  bool closes = false;
  for (std::size_t k = 0; k < count_; ++k) {
    const KindJoints::Stop& stop = equations_.kind_joints().stops()[k];
    const bool unbounded = stop.role == RowRole::Motor && std::isinf(stop.max_force);
    if (stop.role == RowRole::Limit ? !at_end(k) : !unbounded) continue;
    ends.push_back(k);
    const bool off = stop.role == RowRole::Motor && rate_of(k) != 0;
    closes = closes || off || rate_of(k) < -kQuiet * speed_;
  }
  if (!closes) return;
  Problem p = problem(ends);
  for (const std::size_t k : ends) p.rate.push_back(rate_of(k));
  std::vector<Mode> modes;
  equations_.push(p.response, solve(p, modes), smooth_.change());
  ++impacts_;
}

/// Which stops hold from now on.
void Stops::decide() {
  look();
  std::vector<std::size_t> here;
  for (std::size_t k = 0; k < count_; ++k) {
    const KindJoints::Stop& stop = equations_.kind_joints().stops()[k];
    const double rate = rate_of(k);
    if (stop.role == RowRole::Limit) {
      modes_[k] = Mode::Free;
      if (at_end(k) && rate <= 8 * kQuiet * speed_) here.push_back(k);
    } else if (std::abs(rate) <= 8 * kQuiet * std::max(speed_, std::abs(stop.speed))) {
      modes_[k] = Mode::Free;
      here.push_back(k);
    } else {
      modes_[k] = rate < 0 ? Mode::Forward : Mode::Backward;
    }
  }
  equations_.hold_stops(modes_);
  equations_.rate(smooth_.time(), smooth_.state().value(), scratch_);
  std::vector<Twist<double>> free(twists_.size());
  for (std::size_t slot = 0; slot < equations_.bodies().size(); ++slot) {
    const double* rate = scratch_.data() + EquationsOfMotion::kPerBody * slot;
    free[equations_.bodies()[slot]] = {{rate[3], rate[4]}, rate[5]};
  }
  Problem p = problem(here);
  for (const std::size_t k : here) p.rate.push_back(along(rows_[k], free) + rows_[k].bias_acceleration);
  std::vector<Mode> modes;
  const std::vector<double> force = solve(p, modes);
  force_scale_ = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    modes_[here[i]] = modes[i];
    force_scale_ = std::max(force_scale_, std::abs(force[i]));
  }
  equations_.hold_stops(modes_);
}

void Stops::settle() {
  const double now = smooth_.time();
  events_at_once_ =
      now - last_event_ <= 4 * std::numeric_limits<double>::epsilon() * now ? events_at_once_ + 1 : 0;
  last_event_ = now;
  if (events_at_once_ > kMostEventsAtOnce)
    throw Error(Error::Kind::Run, "joints", "limits", std::to_string(kMostEventsAtOnce) + " and more",
                "they change at one instant without end; 'plumb-world' may do");
  equations_.set_window(now, now);
  equations_.hold_stops(std::vector<Mode>(count_, Mode::Free));
  look();
  strike();
  decide();
  equations_.project(now, smooth_.change());
  smooth_.restart();
  met_.reset();
  settled_ = true;
}

/// Of each stop: a limit's opening or force, what is left of a motor's force, or of the way to its speed.
void Stops::evaluate(double time, std::span<double> values) {
  smooth_.at(time, false, sample_);
  const std::vector<double>& force = equations_.contact_forces(time, sample_.value()).stop;
  const std::span<const Row<double>> rows = equations_.stop_rows();
  std::size_t held = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    const KindJoints::Stop& stop = equations_.kind_joints().stops()[k];
    if (modes_[k] == Mode::Held) {
      const double f = force[held++];
      values[k] = stop.role == RowRole::Limit ? f : stop.max_force - std::abs(f);
    } else if (stop.role == RowRole::Limit) {
      values[k] = rows[k].residual;
    } else {
      const double lacking = stop.speed - along(rows[k], equations_.twists());
      values[k] = modes_[k] == Mode::Forward ? lacking : -lacking;
    }
  }
}

std::optional<Stops::Event> Stops::first_event() {
  for (std::size_t k = 0; k < count_; ++k) {
    const KindJoints::Stop& stop = equations_.kind_joints().stops()[k];
    const double scale = stop.role == RowRole::Motor && std::isfinite(stop.max_force)
                             ? std::max(force_scale_, stop.max_force)
                             : force_scale_;
    tolerance_[k] = modes_[k] == Mode::Held       ? kForceNoise * scale + 1e-300
                    : stop.role == RowRole::Limit ? kNear * std::max(length_, 1.0)
                                                  : 0.25 * kQuiet * speed_;
  }
  const auto fall = first_fall([this](double time, std::span<double> values) { evaluate(time, values); },
                               tolerance_, smooth_.start(), smooth_.time(), kSamples);
  if (!fall) return std::nullopt;
  Event event{fall->time, std::nullopt};
  const bool limit = equations_.kind_joints().stops()[fall->index].role == RowRole::Limit;
  if (limit && modes_[fall->index] == Mode::Free) event.met = fall->index;
  return event;
}

void Stops::stop() {
  if (empty()) return;
  const std::optional<Event> event = first_event();
  if (!event) return;
  smooth_.cut(std::max(event->time, std::nextafter(smooth_.start(), event->time + 1)));
  if (event->met) refine(*event->met);
  met_ = event->met;
  settled_ = false;
}

/// The polynomial that the event was found on and the step that ends there differ by the step's error:
/// Newton's method on the gap with steps of their own.
void Stops::refine(std::size_t k) {
  constexpr int kMost = 4;
  for (int i = 0; i < kMost; ++i) {
    look();
    const double gap = rows_[k].residual, closing = rate_of(k);
    if (std::abs(gap) <= kNear / 8 * length_ || !(closing < -1e-6 * speed_)) return;
    const double time = smooth_.time() - gap / closing;
    if (time == smooth_.time() || time <= smooth_.start()) return;
    if (time < smooth_.time()) {
      smooth_.cut(time);
    } else {
      smooth_.step(time);
      if (smooth_.time() < time) return;
    }
  }
}

void Stops::save(SnapshotWriter& out) const {
  for (const Mode mode : modes_) out.put(static_cast<std::int64_t>(mode));
  out.put(std::int64_t{settled_});
  out.put(met_ ? static_cast<std::int64_t>(*met_) : std::int64_t{-1});
  out.put(force_scale_);
  out.put(impacts_);
  out.put(last_event_);
  out.put(std::int64_t{events_at_once_});
}

void Stops::restore(SnapshotReader& in) {
  for (Mode& mode : modes_) {
    const auto value = in.get<std::int64_t>();
    in.expect(value >= 0 && value <= static_cast<std::int64_t>(Mode::Backward));
    mode = static_cast<Mode>(value);
  }
  settled_ = in.get<std::int64_t>() != 0;
  const auto met = in.get<std::int64_t>();
  in.expect(met >= -1 && met < static_cast<std::int64_t>(count_));
  met_ = met < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(met));
  force_scale_ = in.get<double>();
  impacts_ = in.get<std::int64_t>();
  last_event_ = in.get<double>();
  events_at_once_ = static_cast<int>(in.get<std::int64_t>());
  equations_.hold_stops(modes_);
}

}  // namespace plumb::precise
