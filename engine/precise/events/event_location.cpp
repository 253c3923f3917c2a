#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/trigonometry.h"
#include "engine/precise/events/contacts.h"

// Locates the first event of a step: shapes that meet, and the end of a contact's mode.
namespace plumb::precise {
namespace {

/// Samples of forces and slips per step.
constexpr int kSamples = 5;
/// Samples per radian of a time-periodic force: 16 per period.
constexpr double kSamplesARadian = 2.6;
/// A contact opens when its force is this far below zero, as a fraction of the largest force: more than
/// rounding, and more than the difference between a step's polynomial and the step itself.
constexpr double kForceNoise = 3e-11;

/// Returns the feature of the neighbouring corner that comes down on the edge when the limit `index` of `f`
/// reaches zero: the previous corner for limit 2, otherwise the next one.
Feature feature_of_height(const Feature& f, const FeatureShape& a, const FeatureShape& b, int index) {
  Feature other = f;
  int& corner = f.kind == Feature::Kind::CornerOfB ? other.b : other.a;
  const FeatureShape& corner_shape = f.kind == Feature::Kind::CornerOfB ? b : a;
  corner = index == 2 ? corner_shape.previous(corner) : corner_shape.next(corner);
  return other;
}

}  // namespace

void Contacts::truncate_at_event() {
  if (empty()) return;
  record_.guard.reset();
  record_.new_pair.reset();
  bounds_.update(integrator_);
  double until = integrator_.time();
  std::optional<Event> event;
  if (!finder_.shapes().empty()) event = first_toi_event(until);
  if (event) until = event->time;
  if (const auto met = limits_and_motors_.first_reached(bounds_, integrator_, until)) {
    until = met->time;
    event = Event{until, Quantity::LimitMotor, std::nullopt, std::nullopt, met->limit, {}};
  }
  if (const auto change = first_mode_change(until)) event = change;
  if (!event) {
    // Pairs that have separated are searched again like any other.
    const auto apart = [&](const ShapePair& pair) { return search_.distance(pair, until) > gap_tolerance_; };
    std::erase_if(touching_, apart);
    std::erase_if(passing_, apart);
    return;
  }
  integrator_.truncate(std::max(event->time, std::nextafter(integrator_.start(), event->time + 1)));
  refine(*event);
  record_cause(*event);
  switch (event->quantity) {
    case Quantity::Force:
      count(ContactEvent::Separation, integrator_.time());
      break;
    case Quantity::Cone:
      count(ContactEvent::SlipStart, integrator_.time());
      break;
    case Quantity::Slip:
      count(ContactEvent::SlipEnd, integrator_.time());
      break;
    case Quantity::Range:
      count(ContactEvent::Change, integrator_.time());
      break;
    case Quantity::Height:
    case Quantity::LimitMotor:
      break;
  }
  limits_and_motors_.set_reached_limit(event->limit);
  resolved_ = false;
}

std::optional<Contacts::Event> Contacts::first_toi_event(double until) {
  std::optional<Event> first;
  for (const ShapePair& pair : overlapping_pairs(finder_, bounds_)) {
    if (std::binary_search(held_.begin(), held_.end(), pair)) continue;
    double from = bounds_.start();
    if (std::binary_search(passing_.begin(), passing_.end(), pair)) {
      const auto apart =
          search_.departure(pair, until, gap_tolerance_, ConservativeAdvancement::Overlap::Allowed).apart;
      if (!apart) continue;
      from = *apart;
    } else if (std::binary_search(touching_.begin(), touching_.end(), pair)) {
      const ConservativeAdvancement::Departure departure = search_.departure(pair, until, gap_tolerance_);
      if (departure.pressed) {
        until = *departure.pressed;
        first = Event{until, Quantity::Height, pair, std::nullopt, std::nullopt, {}};
        continue;
      }
      if (!departure.apart) continue;
      from = *departure.apart;
    }
    const auto time = search_.first_touch(pair, from, until, gap_tolerance_ / 8);
    if (!time) continue;
    until = *time;
    first = Event{until, Quantity::Height, pair, std::nullopt, std::nullopt, {}};
  }
  return first;
}

void Contacts::list_monitored() {
  monitored_.clear();
  tolerance_.clear();
  monitor_contacts();
  for (std::size_t k = 0; k < limits_and_motors_.count(); ++k) {
    if (limits_and_motors_.is_free_limit(k)) continue;
    monitored_.push_back({.quantity = Quantity::LimitMotor, .limit_motor = k});
    tolerance_.push_back(limits_and_motors_.tolerance(k));
  }
}

void Contacts::monitor_contacts() {
  const double acceleration = finder_.scale_of_speed() * finder_.scale_of_speed() / finder_.scale_of_length();
  const auto monitor = [&](Quantity quantity, std::size_t patch, int point, double tolerance,
                           Feature feature = {}) {
    monitored_.push_back({quantity, patch, point, feature, 0});
    tolerance_.push_back(tolerance);
  };
  for (std::size_t p = 0; p < equations_.active_contacts().size(); ++p) {
    const ActiveContact& patch = equations_.active_contacts()[p];
    const double inverse_mass =
        equations_.inverse_mass(patch.a->body) + equations_.inverse_mass(patch.b->body);
    const double force =
        kForceNoise * force_scale_ + (inverse_mass > 0 ? 1e-12 * acceleration / inverse_mass : 0);
    const double rate_tolerance = 0.25e-12 * finder_.scale_of_speed();
    for (int i = 0; i < patch.count; ++i) monitor(Quantity::Force, p, i, force);
    if (patch.sticks()) monitor(Quantity::Cone, p, 0, force);
    if (patch.friction > 0 && patch.mode != 0) monitor(Quantity::Slip, p, 0, rate_tolerance);
    for (int i = 0; i < patch.count; ++i) {
      const Feature& f = patch.features[i];
      const FeatureLimits limits =
          feature_limits_of(f, *patch.a, bounds_.at(patch.a->body, bounds_.start()).pose, *patch.b,
                            bounds_.at(patch.b->body, bounds_.start()).pose);
      for (int k = 0; k < limits.count; ++k) {
        if (!limits.is_corner_gap[k]) {
          monitor(Quantity::Range, p, 4 * i + k, 2 * gap_tolerance_);
        } else if (patch.count == 1) {
          monitor(Quantity::Height, p, k, gap_tolerance_ / 8, feature_of_height(f, *patch.a, *patch.b, k));
        }
      }
    }
  }
}

void Contacts::evaluate(double time, std::span<double> values) {
  integrator_.at(time, false, sample_);
  const std::span<const double> y = sample_.value();
  const std::span<const ActiveContact> held = equations_.active_contacts();
  if (!limits_and_motors_.empty()) {
    limit_motor_values_.resize(limits_and_motors_.count());
    limits_and_motors_.evaluate(time, y, limit_motor_values_);
  }
  static const ContactForces kNone;
  const bool forces_known = !limits_and_motors_.empty() && equations_.has_active_constraints();
  const ContactForces& forces = forces_known   ? equations_.last_contact_forces()
                                : held.empty() ? kNone
                                               : equations_.contact_forces(time, y);
  std::vector<std::size_t> first_point(held.size() + 1, 0);
  for (std::size_t p = 0; p < held.size(); ++p)
    first_point[p + 1] = first_point[p] + static_cast<std::size_t>(held[p].count);
  for (std::size_t w = 0; w < monitored_.size(); ++w) {
    const Monitored& monitored = monitored_[w];
    if (monitored.quantity == Quantity::LimitMotor) {
      values[w] = limit_motor_values_[monitored.limit_motor];
    } else {
      values[w] = contact_value(monitored, forces, first_point[monitored.patch],
                                [&](const FeatureShape& o) { return bounds_.at(o.body, time); });
    }
  }
}

/// Returns a monitored quantity of a held contact; `motion_of` gives the pose and the twist of a shape's
/// body.
template <class MotionOf>
double Contacts::contact_value(const Monitored& monitored, const ContactForces& forces, std::size_t first,
                               const MotionOf& motion_of) const {
  const ActiveContact& patch = equations_.active_contacts()[monitored.patch];
  switch (monitored.quantity) {
    case Quantity::Force:
      return forces.normal[first + static_cast<std::size_t>(monitored.point)];
    case Quantity::Cone: {
      double normal = 0;
      for (int i = 0; i < patch.count; ++i) normal += forces.normal[first + static_cast<std::size_t>(i)];
      // At the tip of the friction cone the contact opens, which is not a slip. Without a tangential force
      // the contact never leaves the cone.
      return patch.friction * std::max(normal, 0.0) - std::abs(forces.tangent[monitored.patch]);
    }
    case Quantity::Slip: {
      const StepMotionBounds::BodyMotion a = motion_of(*patch.a), b = motion_of(*patch.b);
      const ContactRows rows =
          rows_of(patch.features[0], *patch.a, a.pose, a.twist, *patch.b, b.pose, b.twist);
      return patch.mode * speed_along(rows.tangent, a.twist, b.twist);
    }
    case Quantity::Range:
    case Quantity::Height: {
      const int index = monitored.quantity == Quantity::Height ? 0 : monitored.point / 4;
      const FeatureLimits limits = feature_limits_of(
          patch.features[index], *patch.a, motion_of(*patch.a).pose, *patch.b, motion_of(*patch.b).pose);
      return limits.value[monitored.point % 4];
    }
    case Quantity::LimitMotor:
      break;
  }
  return 0;
}

/// Records the cause of the last step's end.
void Contacts::record_cause(const Event& event) {
  if (event.new_pair) {
    record_.new_pair = event.new_pair;
  } else if (event.limit) {
    record_.guard = Guard{.kind = Guard::Kind::Limit, .limit_motor = *event.limit};
  } else if (event.corner_contact) {
    record_.guard = Guard{.kind = Guard::Kind::Gap,
                          .pair = held_[event.corner_contact->first],
                          .feature = event.corner_contact->second};
  } else {
    record_.guard = Guard{.kind = Guard::Kind::Quantity,
                          .limit_motor = event.monitored.limit_motor,
                          .patch = event.monitored.patch,
                          .monitored = static_cast<int>(event.monitored.quantity),
                          .point = event.monitored.point};
  }
}

double Contacts::guard_value(const Guard& guard, double time, std::span<const double> y) {
  if (guard.kind == Guard::Kind::Limit)
    return limits_and_motors_.gap_of_limit(guard.limit_motor, time, y).gap;
  update_states(time, y);
  const auto motion_of = [&](const FeatureShape& o) {
    const BodyState& s = states_[o.body];
    return StepMotionBounds::BodyMotion{{s.position, rotation_of(s.angle)}, {s.velocity, s.angular_velocity}};
  };
  if (guard.kind == Guard::Kind::Gap) {
    const FeatureShape &a = finder_.shapes()[guard.pair.a], &b = finder_.shapes()[guard.pair.b];
    return gap_of(guard.feature, a, motion_of(a).pose, b, motion_of(b).pose).value;
  }
  if (guard.kind == Guard::Kind::Rate) {
    const FeatureShape &a = finder_.shapes()[guard.pair.a], &b = finder_.shapes()[guard.pair.b];
    const StepMotionBounds::BodyMotion at_a = motion_of(a), at_b = motion_of(b);
    const ContactRows rows = rows_of(guard.feature, a, at_a.pose, at_a.twist, b, at_b.pose, at_b.twist);
    return speed_along(rows.normal, at_a.twist, at_b.twist);
  }
  const auto quantity = static_cast<Quantity>(guard.monitored);
  if (quantity == Quantity::LimitMotor) {
    limit_motor_values_.resize(limits_and_motors_.count());
    limits_and_motors_.evaluate(time, y, limit_motor_values_);
    return limit_motor_values_[guard.limit_motor];
  }
  std::size_t first = 0;
  for (std::size_t p = 0; p < guard.patch; ++p)
    first += static_cast<std::size_t>(equations_.active_contacts()[p].count);
  const bool by_forces = quantity == Quantity::Force || quantity == Quantity::Cone;
  const ContactForces& forces =
      by_forces ? equations_.contact_forces(time, y) : equations_.last_contact_forces();
  return contact_value({quantity, static_cast<std::size_t>(guard.patch), guard.point, {}, 0}, forces, first,
                       motion_of);
}

std::vector<Contacts::Guard> Contacts::guards_of_modes() const {
  std::vector<Guard> guards;
  const auto add = [&](Quantity quantity, std::size_t limit_motor, std::size_t patch, int point) {
    guards.push_back({.kind = Guard::Kind::Quantity,
                      .limit_motor = limit_motor,
                      .patch = patch,
                      .monitored = static_cast<int>(quantity),
                      .point = point});
  };
  for (std::size_t p = 0; p < equations_.active_contacts().size(); ++p) {
    const ActiveContact& patch = equations_.active_contacts()[p];
    for (int i = 0; i < patch.count; ++i) add(Quantity::Force, 0, p, i);
    if (patch.sticks()) add(Quantity::Cone, 0, p, 0);
    if (patch.friction > 0 && patch.mode != 0) add(Quantity::Slip, 0, p, 0);
  }
  for (std::size_t k = 0; k < limits_and_motors_.count(); ++k) {
    if (!limits_and_motors_.is_free_limit(k)) add(Quantity::LimitMotor, k, 0, 0);
  }
  return guards;
}

void Contacts::copy_modes(const Contacts& other) {
  held_ = other.held_;
  std::vector<ActiveContact> patches(other.equations_.active_contacts().begin(),
                                     other.equations_.active_contacts().end());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p].a = &finder_.shapes()[held_[p].a];
    patches[p].b = &finder_.shapes()[held_[p].b];
    ContactCandidate own{.pair = held_[p]};
    finder_.set_coefficients(own);
    patches[p].friction = own.friction, patches[p].sliding_friction = own.sliding_friction;
  }
  equations_.set_contacts(std::move(patches));
  limits_and_motors_.copy_modes(other.limits_and_motors_);
}

void Contacts::impacts_at(double time, std::vector<ContactCandidate> candidates, Compensated& y) {
  update_states(time, y.value());
  std::span<const Row<double>> limits;
  if (!limits_and_motors_.empty()) limits = equations_.limit_motor_rows(time, y.value());
  for (ContactCandidate& candidate : candidates) {
    if (candidate.limit) {
      candidate.rows[0].normal = limits[*candidate.limit];
    } else {
      finder_.set_coefficients(candidate);
    }
    finder_.update_rates(states_, candidate);
  }
  impact_solver_.resolve(time, candidates, states_, y, [&](const ContactCandidate& candidate, int point) {
    return finder_.restitution_at(candidate, point);
  });
}

std::optional<Contacts::Event> Contacts::first_mode_change(double until) {
  if (held_.empty() && limits_and_motors_.empty()) return std::nullopt;
  list_monitored();
  const auto crossing =
      first_zero_crossing([this](double time, std::span<double> values) { evaluate(time, values); },
                          tolerance_, integrator_.start(), until, samples_until(until));
  if (!crossing) return std::nullopt;
  const Monitored& monitored = monitored_[crossing->index];
  Event event{crossing->time, monitored.quantity, std::nullopt, std::nullopt, std::nullopt, monitored};
  if (monitored.quantity == Quantity::Height) event.corner_contact = {monitored.patch, monitored.feature};
  return event;
}

/// Step sizes adapt to the motion only. With contacts at rest, time-periodic forces need their own sampling
/// rate.
int Contacts::samples_until(double until) const {
  constexpr double kMaxSamples = 65536;
  const double radians = fastest_force_ * (until - integrator_.start());
  return std::max(kSamples, static_cast<int>(std::min(std::ceil(kSamplesARadian * radians), kMaxSamples)));
}

/// Corrects the end of the step. The event was found on the step's polynomial, from which the step that ends
/// at the event differs by the step's error. Each iteration of Newton's method on the gap makes a step to a
/// new time.
void Contacts::refine(const Event& event) {
  constexpr int kMaxIterations = 4;
  if (event.limit) return refine_limit(*event.limit);
  if (!event.new_pair && !event.corner_contact) return;
  const double start = integrator_.start();
  for (int i = 0; i < kMaxIterations; ++i) {
    update_states();
    const ShapePair pair = event.new_pair ? *event.new_pair : held_[event.corner_contact->first];
    const FeatureShape &a = finder_.shapes()[pair.a], &b = finder_.shapes()[pair.b];
    const StepMotionBounds::BodyMotion at_a{{states_[a.body].position, rotation_of(states_[a.body].angle)},
                                            {states_[a.body].velocity, states_[a.body].angular_velocity}};
    const StepMotionBounds::BodyMotion at_b{{states_[b.body].position, rotation_of(states_[b.body].angle)},
                                            {states_[b.body].velocity, states_[b.body].angular_velocity}};
    const Feature feature = event.new_pair ? touching_features(a, at_a.pose, at_a.twist, b, at_b.pose,
                                                               at_b.twist, gap_tolerance_)[0]
                                           : event.corner_contact->second;
    const Row<double> row = rows_of(feature, a, at_a.pose, at_a.twist, b, at_b.pose, at_b.twist).normal;
    const double gap_rate = speed_along(row, at_a.twist, at_b.twist);
    if (std::abs(row.residual) <= gap_tolerance_ / 64 || !(gap_rate < -1e-6 * finder_.scale_of_speed()))
      return;
    const double time = integrator_.time() - row.residual / gap_rate;
    if (time == integrator_.time() || time <= start) return;
    // Cuts from the step's start, even for a later time: a further step would lose the part that has not been
    // read yet.
    integrator_.truncate(time);
  }
}

void Contacts::refine_limit(std::size_t limit) {
  constexpr int kMaxIterations = 4;
  const double length = finder_.scale_of_length(), start = integrator_.start();
  for (int i = 0; i < kMaxIterations; ++i) {
    const LimitsAndMotors::LimitGap at =
        limits_and_motors_.gap_of_limit(limit, integrator_.time(), integrator_.state().value());
    if (std::abs(at.gap) <= 1e-14 * length || !(at.rate < -1e-6 * finder_.scale_of_speed())) return;
    const double time = integrator_.time() - at.gap / at.rate;
    if (time == integrator_.time() || time <= start) return;
    // Cuts from the step's start, even for a later time: a further step would lose the part that has not been
    // read yet.
    integrator_.truncate(time);
  }
}

}  // namespace plumb::precise
