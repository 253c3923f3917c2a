#include "engine/precise/sensitivity/sensitivities.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/integrate/dop853.h"
#include "engine/integrate/step_control.h"
#include "engine/precise/events/state_members.h"

namespace plumb::precise {
namespace {

constexpr std::size_t kPerBody = EquationsOfMotion::kPerBody;

/// Limits on the error of a step of the variational equations, relative to the derivatives' size. The lower
/// one is the rounding of their differences.
constexpr double kMinTolerance = 1e-11, kMaxTolerance = 1e-9;
/// Number of impacts at one instant that count as a cascade.
constexpr std::int64_t kCascade = 100;
/// The parameter shifts two impacts at one instant together if the shifts of their times differ by less than
/// this, in units of the scene's own time over the parameter's scale.
constexpr double kTogether = 1e-7;
/// Zeros of two guards count as one instant if they are closer than this fraction of the scene's own time.
/// Events are located to about 1e-12 of it.
constexpr double kSameTime = 1e-9;
constexpr int kMaxSteps = 100000;

Compensated as_state(std::span<const double> y) {
  Compensated state(y.size());
  for (std::size_t i = 0; i < y.size(); ++i) state.set(i, y[i]);
  return state;
}

}  // namespace

Sensitivities::Sensitivities(const Scene& scene, std::vector<Variation> variations, const Precise& precise)
    : tolerance_(std::clamp(1e-3 * precise.tolerance, kMinTolerance, kMaxTolerance)),
      own_(std::make_unique<SceneModel>(scene, precise)),
      failures_(variations.size()),
      values_(Variation::kOffsets.size()) {
  for (const Variation& variation : variations) {
    names_.push_back(variation.name);
    steps_.push_back(variation.step);
    initial_only_.push_back(variation.initial_only);
    auto& around = perturbed_.emplace_back();
    for (std::size_t i = 0; i < around.size(); ++i) {
      around[i] = std::make_unique<SceneModel>(variation.scenes[i], precise);
      const ScenePartition &partition = around[i]->partition, &own = own_->partition;
      if (partition.integrated == own.integrated && partition.ballistic == own.ballistic &&
          partition.shapes.size() == own.shapes.size() && partition.constant_forces == own.constant_forces)
        continue;
      throw Error(Error::Kind::Value, "parameter", "", variation.name,
                  "its value is the one at which a force or a contact is left out of the scene: a derivative "
                  "there has one side only; give it a value beside that");
    }
  }
  const Scales scales = scales_of(scene, own_->partition);
  time_scale_ = scales.length / scales.speed;
  const std::size_t n = own_->equations.dimension();
  for (std::size_t i = 0; i < n; ++i) {
    const double lengths[kPerBody] = {scales.length, scales.length, 1, scales.length, scales.length, 1};
    scale_.push_back(lengths[i % kPerBody] / (i % kPerBody < 3 ? 1 : time_scale_));
  }
  const std::span<const double> start = own_->start.value();
  now_.y.assign(start.begin(), start.end());
  now_.by.assign(size(), Values(n, 0.0));
  for (std::size_t j = 0; j < size(); ++j) {
    differentiate_parameter(
        j,
        [](SceneModel& perturbed, double, std::span<const double>, std::span<double> out) {
          std::copy(perturbed.start.value().begin(), perturbed.start.value().end(), out.begin());
        },
        present(), now_.by[j]);
  }
}

template <class Change>
void Sensitivities::for_each_model(const Change& change) {
  change(*own_);
  for (auto& around : perturbed_) {
    for (auto& perturbed : around) change(*perturbed);
  }
}

void Sensitivities::set_windows(double time) {
  for_each_model([&](SceneModel& any) { any.set_window(time); });
}

void Sensitivities::fail(std::size_t parameter, NoDerivative reason) {
  if (!failures_[parameter]) failures_[parameter] = Failure{reason, now_.time};
}

void Sensitivities::fail_all(NoDerivative reason, double time) {
  for (auto& failure : failures_) {
    if (!failure) failure = Failure{reason, time};
  }
}

void Sensitivities::throw_not_differentiable(std::size_t parameter, NoDerivative reason, double time) const {
  const Failure failure = failures_[parameter].value_or(Failure{reason, time});
  throw NotDifferentiable(names_[parameter], failure.reason, failure.time);
}

/// Returns the length of a direction in units of the scene's scales.
double Sensitivities::norm(std::span<const double> direction) const {
  double largest = 0;
  for (std::size_t i = 0; i < direction.size(); ++i)
    largest = std::max(largest, std::abs(direction[i]) / scale_[i]);
  return largest;
}

/// The state's equations and the variational equations of all parameters, one after the other.
class Sensitivities::VariationalFlow final : public Flow {
 public:
  VariationalFlow(Sensitivities& all, std::span<const std::size_t> parameters)
      : all_(all), parameters_(parameters), part_(all.scale_.size()) {}

  void rate(double time, std::span<const double> y, std::span<double> out) override {
    const std::size_t n = all_.scale_.size();
    const Point from{time, y.first(n)};
    law_(*all_.own_, time, from.y, out.first(n));
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
      const std::span<const double> by = y.subspan((k + 1) * n, n);
      const std::span<double> change = out.subspan((k + 1) * n, n);
      all_.differentiate_state(law_, from, {0, by}, change);
      if (!all_.initial_only_[parameters_[k]]) {
        all_.differentiate_parameter(parameters_[k], law_, from, part_);
        for (std::size_t i = 0; i < n; ++i) change[i] += part_[i];
      }
      // The derivative of a position is the velocity, under any laws.
      for (std::size_t i = 0; i < n; ++i) {
        if (i % kPerBody < 3) change[i] = by[i + 3];
      }
    }
  }

 private:
  Sensitivities& all_;
  std::span<const std::size_t> parameters_;
  Values part_;
  const Function law_ = [](SceneModel& any, double time, std::span<const double> y, std::span<double> rate) {
    any.equations.rate(time, y, rate);
  };
};

/// Integrates the state and the derivatives by `parameters` to `end`, between events. Returns the parameters
/// whose derivatives were lost, because no step is short enough or they are not finite.
std::vector<std::size_t> Sensitivities::integrate(Present& present, std::span<const std::size_t> parameters,
                                                  double end) {
  const std::size_t n = scale_.size();
  if (n == 0 || parameters.empty() || !(end > present.time)) {
    present.time = end;
    return {};
  }
  set_windows(present.time);
  Values y(n * (1 + parameters.size())), error_scale(y.size());
  Dop853 method(y.size());
  VariationalFlow flow(*this, parameters);
  StepControl control;
  std::copy(present.y.begin(), present.y.end(), y.begin());
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    std::copy(present.by[parameters[k]].begin(), present.by[parameters[k]].end(),
              y.begin() + static_cast<std::ptrdiff_t>((k + 1) * n));
  }
  double time = present.time, proposed = end - time;
  bool lost = false;
  flow.rate(time, y, method.first_rate());
  for (int steps = 0; time < end && !lost; ++steps) {
    for (std::size_t part = 0; part * n < y.size(); ++part) {
      const std::span<const double> by = std::span<const double>(y).subspan(part * n, n);
      const double size = part == 0 ? 1 : std::max(norm(by), Variation::kStep / steps_[parameters[part - 1]]);
      for (std::size_t i = 0; i < n; ++i) error_scale[part * n + i] = tolerance_ * size * scale_[i];
      for (std::size_t i = 0; part == 0 && i < n; ++i)
        error_scale[i] = std::max(error_scale[i], tolerance_ * std::abs(by[i]));
    }
    const double h = std::min(proposed, end - time);
    method.step(flow, time, h, y);
    const double error = method.error(h, error_scale);
    lost = steps == kMaxSteps || !(h > 4 * std::numeric_limits<double>::epsilon() * time);
    if (!(error <= 1)) {
      proposed = h * control.after_rejection(error);
      continue;
    }
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += method.increment()[i];
    time = h == end - time ? end : time + h;
    if (time == end) break;
    proposed = std::max(h, proposed) * control.after_acceptance(error);
    flow.rate(time, y, method.last_rate());
    method.advance();
  }
  present.time = end;
  std::copy(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(n), present.y.begin());
  std::vector<std::size_t> all_lost;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const auto from = y.begin() + static_cast<std::ptrdiff_t>((k + 1) * n);
    std::copy(from, from + static_cast<std::ptrdiff_t>(n), present.by[parameters[k]].begin());
    const auto infinite = [](double x) { return !std::isfinite(x); };
    if (lost || std::any_of(from, from + static_cast<std::ptrdiff_t>(n), infinite))
      all_lost.push_back(parameters[k]);
  }
  return all_lost;
}

void Sensitivities::start(double time, const Compensated& given, const Compensated& closed) {
  now_.time = time;
  now_.y.assign(given.value().begin(), given.value().end());
  set_windows(time);
  const auto close = [](SceneModel& any, double t, std::span<const double> y, std::span<double> out) {
    Compensated state = as_state(y);
    any.close_joints(t, state);
    std::copy(state.value().begin(), state.value().end(), out.begin());
  };
  Values by(scale_.size());
  for (std::size_t j = 0; j < size(); ++j) {
    if (!is_valid(j)) continue;
    if (!differentiate(j, close, {0, now_.by[j]}, scale_, by)) fail(j, NoDerivative::Singular);
    now_.by[j] = by;
  }
  now_.y.assign(closed.value().begin(), closed.value().end());
  started_ = true;
}

void Sensitivities::advance(double time, const Compensated& y) {
  std::vector<std::size_t> valid;
  for (std::size_t j = 0; j < size(); ++j) {
    if (is_valid(j)) valid.push_back(j);
  }
  for (const std::size_t j : integrate(now_, valid, time)) fail(j, NoDerivative::Singular);
  now_.y.assign(y.value().begin(), y.value().end());
}

void Sensitivities::switch_forces(double time) {
  for_each_model([&](SceneModel& any) { any.ballistic.switch_forces(time); });
}

void Sensitivities::write(std::size_t body, std::optional<std::size_t> slot, double time,
                          const BodyState& state) {
  if (!slot) {
    for_each_model([&](SceneModel& any) { any.ballistic.restart(body, time, state); });
    return;
  }
  for (Values& by : now_.by)
    std::fill_n(by.begin() + static_cast<std::ptrdiff_t>(kPerBody * *slot), kPerBody, 0.0);
}

/// Returns the guard of an event; nullopt if it has none that depends on the motion.
std::optional<Contacts::Guard> Sensitivities::guard_of(const Contacts::Record& record) const {
  if (!record.new_pair) return record.guard;
  for (const ContactCandidate& candidate : record.candidates) {
    if (candidate.limit || candidate.pair != *record.new_pair) continue;
    int fastest = 0;
    for (int i = 1; i < candidate.count; ++i) {
      if (candidate.gap_rate[i] < candidate.gap_rate[fastest]) fastest = i;
    }
    return Contacts::Guard{
        .kind = Contacts::Guard::Kind::Gap, .pair = candidate.pair, .feature = candidate.features[fastest]};
  }
  return std::nullopt;
}

namespace {

/// Returns a function that evaluates a guard.
auto value_of(const Contacts::Guard& guard) {
  return [guard](SceneModel& any, double time, std::span<const double> y, std::span<double> out) {
    out[0] = any.contacts.guard_value(guard, time, y);
  };
}

}  // namespace

/// Returns true if a parameter opens contacts that exist at the start, or presses their shapes together.
bool Sensitivities::opens_initial_contacts(std::size_t j, const Contacts::Record& record) {
  const double size = std::max(Variation::kStep / steps_[j], norm(now_.by[j]));
  const double length[1] = {scale_[0]}, speed[1] = {scale_[kPerBody / 2]};
  for (const ContactCandidate& candidate : record.candidates) {
    for (int i = 0; i < candidate.count && !candidate.limit; ++i) {
      const Contacts::Guard guard{
          .kind = Contacts::Guard::Kind::Gap, .pair = candidate.pair, .feature = candidate.features[i]};
      double change[1] = {0};
      if (!differentiate(j, value_of(guard), {0, now_.by[j]}, length, change)) return true;
      if (std::abs(change[0]) > kTogether * length[0] * size) return true;
      if (std::abs(candidate.gap_rate[i]) > candidate.rate_tolerance) continue;
      const Contacts::Guard rate{
          .kind = Contacts::Guard::Kind::Rate, .pair = candidate.pair, .feature = candidate.features[i]};
      if (!differentiate(j, value_of(rate), {0, now_.by[j]}, speed, change)) return true;
      if (std::abs(change[0]) > kTogether * speed[0] * size) return true;
    }
  }
  return false;
}

/// Removes the slips that a parameter gives to contacts which stick or roll at the start. Friction ends an
/// infinitesimal slip at once, by the impulse that stops it.
void Sensitivities::stop_slips(std::size_t j) {
  const auto project = [](SceneModel& any, double time, std::span<const double> y, std::span<double> out) {
    Compensated state = as_state(y);
    any.equations.project(time, state);
    std::copy(state.value().begin(), state.value().end(), out.begin());
  };
  Values by(scale_.size());
  if (!differentiate(j, project, {0, now_.by[j]}, scale_, by)) fail(j, NoDerivative::Singular);
  now_.by[j] = by;
}

/// Carries one parameter's derivative through the event, up to the impacts; returns the change of the event's
/// time.
double Sensitivities::propagate(std::size_t j, const Contacts::Record& record,
                                std::span<const double> before_rate,
                                const std::optional<Contacts::Guard>& guard, double guard_rate,
                                std::span<const Zero> others) {
  const std::size_t n = scale_.size();
  const double unit = Variation::kStep / steps_[j];
  const double size_of_guard[1] = {std::abs(guard_rate) * time_scale_};
  double time_shift = 0;
  if (guard) {
    double change[1] = {0};
    if (!differentiate(j, value_of(*guard), {0, now_.by[j]}, size_of_guard, change))
      fail(j, NoDerivative::Kink);
    time_shift = -change[0] / guard_rate;
  }
  if (started_ && !guard && opens_initial_contacts(j, record)) fail(j, NoDerivative::Start);
  for (const ContactCandidate& candidate : record.candidates) {
    if (!guard || candidate.limit || own_->contacts.has_contact(candidate.pair)) continue;
    for (int i = 0; i < candidate.count; ++i) {
      if (!closes_at(candidate, i) ||
          (candidate.pair == guard->pair && candidate.features[i] == guard->feature))
        continue;
      const Contacts::Guard other{
          .kind = Contacts::Guard::Kind::Gap, .pair = candidate.pair, .feature = candidate.features[i]};
      double change[1] = {0};
      const double size[1] = {std::abs(candidate.gap_rate[i]) * time_scale_};
      if (!differentiate(j, value_of(other), {0, now_.by[j]}, size, change)) fail(j, NoDerivative::Kink);
      const double shift = -change[0] / candidate.gap_rate[i];
      if (std::abs(shift - time_shift) > kTogether * (time_scale_ * unit + std::abs(time_shift)))
        fail(j, NoDerivative::Simultaneous);
    }
  }
  for (const Zero& zero : others) {
    double change[1] = {0};
    const double size[1] = {std::abs(zero.rate) * time_scale_};
    if (!differentiate(j, value_of(zero.guard), {0, now_.by[j]}, size, change)) fail(j, NoDerivative::Kink);
    if (std::abs(-change[0] / zero.rate - time_shift) >
        kTogether * (time_scale_ * unit + std::abs(time_shift)))
      fail(j, NoDerivative::Simultaneous);
  }
  if (!is_valid(j)) return 0;
  Values& by = now_.by[j];
  for (std::size_t i = 0; i < n; ++i) by[i] += time_shift * before_rate[i];
  if (!record.impacts) return time_shift;
  const auto impacts = [&](SceneModel& any, double time, std::span<const double> y, std::span<double> out) {
    Compensated state = as_state(y);
    any.contacts.impacts_at(time, record.candidates, state);
    std::copy(state.value().begin(), state.value().end(), out.begin());
  };
  Values after(n);
  if (!differentiate(j, impacts, {time_shift, by}, scale_, after)) fail(j, NoDerivative::Kink);
  by = after;
  return time_shift;
}

/// Computes the rate of a guard along the motion, `rate`. Returns true if it is uncertain that the guard
/// reaches zero, because the gap stops closing within its own rounding.
bool Sensitivities::grazes(const Contacts& contacts, const Contacts::Guard& guard,
                           std::span<const double> rate, double& guard_rate) {
  double found[1];
  const double width = differentiate_state(value_of(guard), present(), {1, rate}, found);
  guard_rate = found[0];
  if (!(std::abs(guard_rate) > 0)) return true;
  if (guard.kind == Contacts::Guard::Kind::Quantity) return false;
  // The second derivative of the gap along the motion's parabola.
  double gap[3];
  for (const int place : {-1, 0, 1}) {
    const double s = place * width;
    for (std::size_t i = 0; i < at_.size(); ++i)
      at_[i] = now_.y[i] + s * (rate[i] + (i % kPerBody < 3 ? s / 2 * rate[i + 3] : 0));
    value_of(guard)(*own_, now_.time + s, at_, std::span<double>(gap + 1 + place, 1));
  }
  const double bend = (gap[0] + gap[2] - 2 * gap[1]) / (width * width);
  return !(guard_rate < 0) || guard_rate * guard_rate <= 2 * bend * contacts.gap_tolerance();
}

/// Returns the other guards that are zero together with the event's guard: their modes change at the same
/// instant, without events of their own.
std::vector<Sensitivities::Zero> Sensitivities::coincident_zeros(const Contacts::Guard& guard,
                                                                 std::span<const double> rate) {
  std::vector<Zero> zeros;
  for (const Contacts::Guard& other : own_->contacts.guards_of_modes()) {
    if (other == guard) continue;
    double value[1], found[1];
    value_of(other)(*own_, now_.time, now_.y, value);
    differentiate_state(value_of(other), present(), {1, rate}, found);
    if (found[0] < 0 && std::abs(value[0]) <= kSameTime * time_scale_ * -found[0])
      zeros.push_back({other, found[0]});
  }
  return zeros;
}

void Sensitivities::pass_event(const Compensated& before, const Compensated& after,
                               const Contacts& contacts) {
  const Contacts::Record& record = contacts.record();
  const std::size_t n = scale_.size();
  now_.y.assign(before.value().begin(), before.value().end());
  set_windows(now_.time);
  if (record.zeno || record.impact_count > kCascade) fail_all(NoDerivative::Zeno, now_.time);
  if (record.paradox) fail_all(NoDerivative::Paradox, now_.time);
  const std::optional<Contacts::Guard> guard = guard_of(record);
  Values rate(n);
  own_->equations.rate(now_.time, now_.y, rate);
  double guard_rate = 0;
  if (guard && grazes(contacts, *guard, rate, guard_rate)) fail_all(NoDerivative::Grazing, now_.time);
  const std::vector<Zero> others = guard ? coincident_zeros(*guard, rate) : std::vector<Zero>{};
  std::vector<double> time_shift(size(), 0.0);
  for (std::size_t j = 0; j < size(); ++j) {
    if (is_valid(j)) time_shift[j] = propagate(j, record, rate, guard, guard_rate, others);
  }
  for_each_model([&](SceneModel& any) { any.contacts.copy_modes(contacts); });
  now_.y.assign(after.value().begin(), after.value().end());
  own_->equations.rate(now_.time, now_.y, rate);
  for (std::size_t j = 0; j < size(); ++j) {
    for (std::size_t i = 0; i < n && time_shift[j] != 0; ++i) now_.by[j][i] -= time_shift[j] * rate[i];
    if (started_ && is_valid(j) && own_->equations.has_active_constraints()) stop_slips(j);
  }
  started_ = false;
}

std::vector<BodyState> Sensitivities::at(std::size_t parameter, double time, std::size_t bodies) {
  Present there = now_;
  const std::size_t asked[] = {parameter};
  if (!is_valid(parameter) || !integrate(there, asked, time).empty())
    throw_not_differentiable(parameter, NoDerivative::Singular, time);
  std::vector<BodyState> out(bodies);
  for (std::size_t slot = 0; slot < own_->partition.integrated.size(); ++slot)
    out[own_->partition.integrated[slot]] = EquationsOfMotion::state(there.by[parameter], slot);
  Values by(kPerBody);
  for (const std::size_t body : own_->partition.ballistic) {
    differentiate_parameter(
        parameter,
        [&](SceneModel& perturbed, double, std::span<const double>, std::span<double> y) {
          const BodyState s = perturbed.ballistic.at(body, time).state;
          const double numbers[kPerBody] = {s.position.x, s.position.y, s.angle,
                                            s.velocity.x, s.velocity.y, s.angular_velocity};
          std::copy(std::begin(numbers), std::end(numbers), y.begin());
        },
        present(), by);
    out[body] = EquationsOfMotion::state(by, 0);
  }
  return out;
}

void Sensitivities::save(SnapshotWriter& out) const {
  out.put(now_.time);
  out.put(std::int64_t{started_});
  for (const double number : now_.y) out.put(number);
  for (std::size_t j = 0; j < size(); ++j) {
    out.put(failures_[j] ? static_cast<std::int64_t>(failures_[j]->reason) : std::int64_t{-1});
    out.put(failures_[j] ? failures_[j]->time : 0.0);
    for (const double number : now_.by[j]) out.put(number);
    for (const auto& perturbed : perturbed_[j]) {
      for (const BallisticMotion::Arc& arc : perturbed->ballistic.arcs()) out.put(arc);
    }
  }
  for (const BallisticMotion::Arc& arc : own_->ballistic.arcs()) out.put(arc);
}

void Sensitivities::restore(SnapshotReader& in, const Contacts& contacts) {
  now_.time = in.get<double>();
  started_ = in.get<std::int64_t>() != 0;
  for (double& number : now_.y) number = in.get<double>();
  for (std::size_t j = 0; j < size(); ++j) {
    const auto reason = in.get<std::int64_t>();
    const auto time = in.get<double>();
    in.expect(reason >= -1 && reason <= static_cast<std::int64_t>(NoDerivative::Singular));
    failures_[j].reset();
    if (reason >= 0) failures_[j] = Failure{static_cast<NoDerivative>(reason), time};
    for (double& number : now_.by[j]) number = in.get<double>();
    for (auto& perturbed : perturbed_[j]) {
      for (BallisticMotion::Arc& arc : perturbed->ballistic.arcs()) arc = in.get<BallisticMotion::Arc>();
    }
  }
  for (BallisticMotion::Arc& arc : own_->ballistic.arcs()) arc = in.get<BallisticMotion::Arc>();
  for_each_model([&](SceneModel& any) { any.contacts.copy_modes(contacts); });
}

}  // namespace plumb::precise
