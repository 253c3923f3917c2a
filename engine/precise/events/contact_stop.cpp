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
  const FeatureShape& cornered = f.kind == Feature::Kind::CornerOfB ? b : a;
  corner = index == 2 ? cornered.previous(corner) : cornered.next(corner);
  return other;
}

}  // namespace

void Contacts::stop() {
  if (empty()) return;
  record_.guard.reset();
  record_.met.reset();
  paths_.take(smooth_);
  double until = smooth_.time();
  std::optional<Event> event;
  if (!finder_.outlines().empty()) event = first_toi_event(until);
  if (event) until = event->time;
  if (const auto met = stops_.first_reached(paths_, smooth_, until)) {
    until = met->time;
    event = Event{until, Quantity::Stop, std::nullopt, std::nullopt, met->limit, {}};
  }
  if (const auto change = first_change(until)) event = change;
  if (!event) {
    // Pairs that have separated are searched again like any other.
    const auto apart = [&](const OutlinePair& pair) { return search_.distance(pair, until) > near_; };
    std::erase_if(touching_, apart);
    std::erase_if(passing_, apart);
    return;
  }
  smooth_.cut(std::max(event->time, std::nextafter(smooth_.start(), event->time + 1)));
  refine(*event);
  note(*event);
  switch (event->quantity) {
    case Quantity::Force:
      count(ContactEvent::Separation, smooth_.time());
      break;
    case Quantity::Cone:
      count(ContactEvent::SlipStart, smooth_.time());
      break;
    case Quantity::Slip:
      count(ContactEvent::SlipEnd, smooth_.time());
      break;
    case Quantity::Range:
      count(ContactEvent::Change, smooth_.time());
      break;
    case Quantity::Height:
    case Quantity::Stop:
      break;
  }
  stops_.meet(event->limit);
  settled_ = false;
}

std::optional<Contacts::Event> Contacts::first_toi_event(double until) {
  std::optional<Event> first;
  for (const OutlinePair& pair : near_pairs(finder_, paths_)) {
    if (std::binary_search(held_.begin(), held_.end(), pair)) continue;
    double from = paths_.start();
    if (std::binary_search(passing_.begin(), passing_.end(), pair)) {
      const auto apart =
          search_.departure(pair, until, near_, ConservativeAdvancement::Overlap::Allowed).apart;
      if (!apart) continue;
      from = *apart;
    } else if (std::binary_search(touching_.begin(), touching_.end(), pair)) {
      const ConservativeAdvancement::Departure departure = search_.departure(pair, until, near_);
      if (departure.pressed) {
        until = *departure.pressed;
        first = Event{until, Quantity::Height, pair, std::nullopt, std::nullopt, {}};
        continue;
      }
      if (!departure.apart) continue;
      from = *departure.apart;
    }
    const auto time = search_.first(pair, from, until, near_ / 8);
    if (!time) continue;
    until = *time;
    first = Event{until, Quantity::Height, pair, std::nullopt, std::nullopt, {}};
  }
  return first;
}

void Contacts::list_monitored() {
  monitored_.clear();
  tolerance_.clear();
  watch_contacts();
  for (std::size_t k = 0; k < stops_.count(); ++k) {
    if (stops_.is_free_limit(k)) continue;
    monitored_.push_back({.quantity = Quantity::Stop, .stop = k});
    tolerance_.push_back(stops_.tolerance(k));
  }
}

void Contacts::watch_contacts() {
  const double acceleration = finder_.scale_of_speed() * finder_.scale_of_speed() / finder_.scale_of_length();
  const auto watch = [&](Quantity quantity, std::size_t patch, int point, double tolerance,
                         Feature feature = {}) {
    monitored_.push_back({quantity, patch, point, feature, 0});
    tolerance_.push_back(tolerance);
  };
  for (std::size_t p = 0; p < equations_.held().size(); ++p) {
    const ActiveContact& patch = equations_.held()[p];
    const double light = equations_.inverse_mass(patch.a->body) + equations_.inverse_mass(patch.b->body);
    const double force = kForceNoise * force_scale_ + (light > 0 ? 1e-12 * acceleration / light : 0);
    const double quiet = 0.25e-12 * finder_.scale_of_speed();
    for (int i = 0; i < patch.count; ++i) watch(Quantity::Force, p, i, force);
    if (patch.sticks()) watch(Quantity::Cone, p, 0, force);
    if (patch.friction > 0 && patch.mode != 0) watch(Quantity::Slip, p, 0, quiet);
    for (int i = 0; i < patch.count; ++i) {
      const Feature& f = patch.features[i];
      const Limits limits = limits_of(f, *patch.a, paths_.at(patch.a->body, paths_.start()).pose, *patch.b,
                                      paths_.at(patch.b->body, paths_.start()).pose);
      for (int k = 0; k < limits.count; ++k) {
        if (!limits.comes_down[k]) {
          watch(Quantity::Range, p, 4 * i + k, 2 * near_);
        } else if (patch.count == 1) {
          watch(Quantity::Height, p, k, near_ / 8, feature_of_height(f, *patch.a, *patch.b, k));
        }
      }
    }
  }
}

void Contacts::evaluate(double time, std::span<double> values) {
  smooth_.at(time, false, sample_);
  const std::span<const double> y = sample_.value();
  const std::span<const ActiveContact> held = equations_.held();
  if (!stops_.empty()) {
    stop_values_.resize(stops_.count());
    stops_.evaluate(time, y, stop_values_);
  }
  static const ContactForces kNone;
  const bool forces_known = !stops_.empty() && equations_.holds_anything();
  const ContactForces& forces = forces_known   ? equations_.last_contact_forces()
                                : held.empty() ? kNone
                                               : equations_.contact_forces(time, y);
  std::vector<std::size_t> first_point(held.size() + 1, 0);
  for (std::size_t p = 0; p < held.size(); ++p)
    first_point[p + 1] = first_point[p] + static_cast<std::size_t>(held[p].count);
  for (std::size_t w = 0; w < monitored_.size(); ++w) {
    const Monitored& monitored = monitored_[w];
    if (monitored.quantity == Quantity::Stop) {
      values[w] = stop_values_[monitored.stop];
    } else {
      values[w] = contact_value(monitored, forces, first_point[monitored.patch],
                                [&](const FeatureShape& o) { return paths_.at(o.body, time); });
    }
  }
}

/// Returns a monitored quantity of a held contact; `placed` gives the pose and the twist of a shape's body.
template <class Placed>
double Contacts::contact_value(const Monitored& monitored, const ContactForces& forces, std::size_t first,
                               const Placed& placed) const {
  const ActiveContact& patch = equations_.held()[monitored.patch];
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
      const StepMotionBounds::Placed a = placed(*patch.a), b = placed(*patch.b);
      const ContactRows rows =
          rows_of(patch.features[0], *patch.a, a.pose, a.twist, *patch.b, b.pose, b.twist);
      return patch.mode * speed_along(rows.tangent, a.twist, b.twist);
    }
    case Quantity::Range:
    case Quantity::Height: {
      const int index = monitored.quantity == Quantity::Height ? 0 : monitored.point / 4;
      const Limits limits =
          limits_of(patch.features[index], *patch.a, placed(*patch.a).pose, *patch.b, placed(*patch.b).pose);
      return limits.value[monitored.point % 4];
    }
    case Quantity::Stop:
      break;
  }
  return 0;
}

/// Records the cause of the last step's end.
void Contacts::note(const Event& event) {
  if (event.meet) {
    record_.met = event.meet;
  } else if (event.limit) {
    record_.guard = Guard{.kind = Guard::Kind::Limit, .stop = *event.limit};
  } else if (event.down) {
    record_.guard =
        Guard{.kind = Guard::Kind::Gap, .pair = held_[event.down->first], .feature = event.down->second};
  } else {
    record_.guard = Guard{.kind = Guard::Kind::Quantity,
                          .stop = event.monitored.stop,
                          .patch = event.monitored.patch,
                          .monitored = static_cast<int>(event.monitored.quantity),
                          .point = event.monitored.point};
  }
}

double Contacts::guard_value(const Guard& guard, double time, std::span<const double> y) {
  if (guard.kind == Guard::Kind::Limit) return stops_.approach(guard.stop, time, y).gap;
  look_at_states(time, y);
  const auto placed = [&](const FeatureShape& o) {
    const BodyState& s = states_[o.body];
    return StepMotionBounds::Placed{{s.position, rotation_of(s.angle)}, {s.velocity, s.angular_velocity}};
  };
  if (guard.kind == Guard::Kind::Gap) {
    const FeatureShape &a = finder_.outlines()[guard.pair.a], &b = finder_.outlines()[guard.pair.b];
    return gap_of(guard.feature, a, placed(a).pose, b, placed(b).pose).value;
  }
  if (guard.kind == Guard::Kind::Rate) {
    const FeatureShape &a = finder_.outlines()[guard.pair.a], &b = finder_.outlines()[guard.pair.b];
    const StepMotionBounds::Placed at_a = placed(a), at_b = placed(b);
    const ContactRows rows = rows_of(guard.feature, a, at_a.pose, at_a.twist, b, at_b.pose, at_b.twist);
    return speed_along(rows.normal, at_a.twist, at_b.twist);
  }
  const auto quantity = static_cast<Quantity>(guard.monitored);
  if (quantity == Quantity::Stop) {
    stop_values_.resize(stops_.count());
    stops_.evaluate(time, y, stop_values_);
    return stop_values_[guard.stop];
  }
  std::size_t first = 0;
  for (std::size_t p = 0; p < guard.patch; ++p) first += static_cast<std::size_t>(equations_.held()[p].count);
  const bool by_forces = quantity == Quantity::Force || quantity == Quantity::Cone;
  const ContactForces& forces =
      by_forces ? equations_.contact_forces(time, y) : equations_.last_contact_forces();
  return contact_value({quantity, static_cast<std::size_t>(guard.patch), guard.point, {}, 0}, forces, first,
                       placed);
}

std::vector<Contacts::Guard> Contacts::guards_of_modes() const {
  std::vector<Guard> guards;
  const auto add = [&](Quantity quantity, std::size_t stop, std::size_t patch, int point) {
    guards.push_back({.kind = Guard::Kind::Quantity,
                      .stop = stop,
                      .patch = patch,
                      .monitored = static_cast<int>(quantity),
                      .point = point});
  };
  for (std::size_t p = 0; p < equations_.held().size(); ++p) {
    const ActiveContact& patch = equations_.held()[p];
    for (int i = 0; i < patch.count; ++i) add(Quantity::Force, 0, p, i);
    if (patch.sticks()) add(Quantity::Cone, 0, p, 0);
    if (patch.friction > 0 && patch.mode != 0) add(Quantity::Slip, 0, p, 0);
  }
  for (std::size_t k = 0; k < stops_.count(); ++k) {
    if (!stops_.is_free_limit(k)) add(Quantity::Stop, k, 0, 0);
  }
  return guards;
}

void Contacts::follow(const Contacts& other) {
  held_ = other.held_;
  std::vector<ActiveContact> patches(other.equations_.held().begin(), other.equations_.held().end());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p].a = &finder_.outlines()[held_[p].a];
    patches[p].b = &finder_.outlines()[held_[p].b];
    ContactCandidate own{.pair = held_[p]};
    finder_.set_coefficients(own);
    patches[p].friction = own.friction, patches[p].sliding_friction = own.sliding_friction;
  }
  equations_.hold_contacts(std::move(patches));
  stops_.follow(other.stops_);
}

void Contacts::impacts_at(double time, std::vector<ContactCandidate> touches, Compensated& y) {
  look_at_states(time, y.value());
  std::span<const Row<double>> limits;
  if (!stops_.empty()) limits = equations_.stop_rows(time, y.value());
  for (ContactCandidate& touch : touches) {
    if (touch.stop) {
      touch.rows[0].normal = limits[*touch.stop];
    } else {
      finder_.set_coefficients(touch);
    }
    finder_.measure(states_, touch);
  }
  law_.resolve(time, touches, states_, y, [&](const ContactCandidate& touch, int point) {
    return finder_.restitution_at(touch, point);
  });
}

std::optional<Contacts::Event> Contacts::first_change(double until) {
  if (held_.empty() && stops_.empty()) return std::nullopt;
  list_monitored();
  const auto fall =
      first_zero_crossing([this](double time, std::span<double> values) { evaluate(time, values); },
                          tolerance_, smooth_.start(), until, samples_until(until));
  if (!fall) return std::nullopt;
  const Monitored& monitored = monitored_[fall->index];
  Event event{fall->time, monitored.quantity, std::nullopt, std::nullopt, std::nullopt, monitored};
  if (monitored.quantity == Quantity::Height) event.down = {monitored.patch, monitored.feature};
  return event;
}

/// Step sizes adapt to the motion only. With contacts at rest, time-periodic forces need their own sampling
/// rate.
int Contacts::samples_until(double until) const {
  constexpr double kMost = 65536;
  const double swings = fastest_force_ * (until - smooth_.start());
  return std::max(kSamples, static_cast<int>(std::min(std::ceil(kSamplesARadian * swings), kMost)));
}

/// Corrects the end of the step. The event was found on the step's polynomial, from which the step that ends
/// at the event differs by the step's error. Each iteration of Newton's method on the gap makes a step to a
/// new time.
void Contacts::refine(const Event& event) {
  constexpr int kMost = 4;
  if (event.limit) return refine_limit(*event.limit);
  if (!event.meet && !event.down) return;
  const double start = smooth_.start();
  for (int i = 0; i < kMost; ++i) {
    look_at_states();
    const OutlinePair pair = event.meet ? *event.meet : held_[event.down->first];
    const FeatureShape &a = finder_.outlines()[pair.a], &b = finder_.outlines()[pair.b];
    const StepMotionBounds::Placed at_a{{states_[a.body].position, rotation_of(states_[a.body].angle)},
                                        {states_[a.body].velocity, states_[a.body].angular_velocity}};
    const StepMotionBounds::Placed at_b{{states_[b.body].position, rotation_of(states_[b.body].angle)},
                                        {states_[b.body].velocity, states_[b.body].angular_velocity}};
    const Feature feature =
        event.meet ? touching_features(a, at_a.pose, at_a.twist, b, at_b.pose, at_b.twist, near_)[0]
                   : event.down->second;
    const Row<double> row = rows_of(feature, a, at_a.pose, at_a.twist, b, at_b.pose, at_b.twist).normal;
    const double closing = speed_along(row, at_a.twist, at_b.twist);
    if (std::abs(row.residual) <= near_ / 64 || !(closing < -1e-6 * finder_.scale_of_speed())) return;
    const double time = smooth_.time() - row.residual / closing;
    if (time == smooth_.time() || time <= start) return;
    // Cuts from the step's start, even for a later time: a further step would lose the part that has not been
    // read yet.
    smooth_.cut(time);
  }
}

void Contacts::refine_limit(std::size_t limit) {
  constexpr int kMost = 4;
  const double length = finder_.scale_of_length(), start = smooth_.start();
  for (int i = 0; i < kMost; ++i) {
    const Stops::Approach at = stops_.approach(limit, smooth_.time(), smooth_.state().value());
    if (std::abs(at.gap) <= 1e-14 * length || !(at.rate < -1e-6 * finder_.scale_of_speed())) return;
    const double time = smooth_.time() - at.gap / at.rate;
    if (time == smooth_.time() || time <= start) return;
    // Cuts from the step's start, even for a later time: a further step would lose the part that has not been
    // read yet.
    smooth_.cut(time);
  }
}

}  // namespace plumb::precise
