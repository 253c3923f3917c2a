#include "engine/simulation/precise_driver.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "engine/scene/error.h"
#include "engine/scene/text.h"
#include "engine/simulation/precise_clock.h"

// The driver apart from its step: reading and writing, snapshots, errors, costs.
namespace plumb::precise {

void PreciseDriver::read(std::span<BodyState> out) const {
  for (const std::size_t body : parts_.flying) out[body] = flight_.at(body, time_).state;
  for (std::size_t slot = 0; slot < parts_.integrated.size(); ++slot) {
    out[parts_.integrated[slot]] = EquationsOfMotion::state(y_.value(), slot);
  }
}

void PreciseDriver::write(std::size_t body, const BodyState& state) {
  BodyState allowed = state;
  if (at_rest_[body]) allowed.velocity = {};
  if (at_rest_[body] || locked_[body]) allowed.angular_velocity = 0;
  if (flight_.holds(body)) {
    flight_.restart(body, time_, allowed);
  } else {
    EquationsOfMotion::set_state(y_, slot_of(body), allowed);
  }
  joints_closed_ = false;
  proposed_step_ = 0;
}

void PreciseDriver::profile(bool on) {
  profiling_ = equations_.cost.on = on;
  equations_.cost.forces = equations_.cost.joints = 0;
  for (Stage& stage : plan_.stages) stage.nanoseconds = 0;
  cost_ = {};
}

Statistics PreciseDriver::statistics() const {
  Statistics all = statistics_;
  all.evaluations = equations_.evaluations();
  return all;
}

void PreciseDriver::check_finite() {
  const auto check = [&](std::size_t body, const BodyState& s) {
    const std::pair<const char*, double> parts[] = {
        {"position.x", s.position.x}, {"position.y", s.position.y}, {"angle", s.angle},
        {"velocity.x", s.velocity.x}, {"velocity.y", s.velocity.y}, {"angular_velocity", s.angular_velocity}};
    for (const auto& [field, value] : parts) {
      if (!std::isfinite(value)) fail("body '" + names_[body] + "'", field, shortest(value), "not finite");
    }
  };
  if (active(kPolynomialFlight)) {
    const Clock clock(profiling_, cost_[kPolynomialFlight]);
    for (const std::size_t body : parts_.flying) check(body, flight_.at(body, time_).state);
  }
  for (std::size_t slot = 0; slot < parts_.integrated.size(); ++slot) {
    check(parts_.integrated[slot], EquationsOfMotion::state(y_.value(), slot));
  }
}

void PreciseDriver::fail(const std::string& subject, const std::string& field, const std::string& value,
                         const std::string& problem) const {
  throw Error(Error::Kind::Run, subject, field, value,
              problem + ", in step " + std::to_string(grid_steps_ + 1) + " at t = " + shortest(time_) +
                  " s; the world is left at that time");
}

/// A step cannot be made small enough: names the body that changes fastest, or is not finite.
void PreciseDriver::blame_fastest() const {
  std::size_t worst = 0;
  double fastest = -1;
  for (std::size_t i = 0; i < y_.size() && !std::isnan(fastest); ++i) {
    const double change = std::abs(runge_kutta_.first_rate()[i]) / error_scale_[i];
    if (change <= fastest) continue;
    worst = i;
    fastest = change;
  }
  const std::string subject =
      y_.size() == 0 ? "the scene"
                     : "body '" + names_[parts_.integrated[worst / EquationsOfMotion::kPerBody]] + "'";
  if (!std::isfinite(fastest)) fail(subject, "acceleration", shortest(fastest), "not finite");
  fail(subject, "step", shortest(proposed_step_) + " s",
       "the motion changes too fast for any step; a larger tolerance or Realtime may do");
}

void PreciseDriver::report_cost() {
  if (!profiling_) return;
  cost_[kForces] = equations_.cost.forces;
  cost_[kJointAccelerations] = equations_.cost.joints;
  for (int i = 0; i < kStageCount; ++i) plan_.stages[i].nanoseconds = cost_[i];
  double& rest =
      plan_.stages[kRungeKutta].nanoseconds;  // what its evaluations and the projection did not take
  rest = std::max(0.0, rest - cost_[kForces] - cost_[kJointAccelerations] - cost_[kProjection]);
}

/// Snapshots are numbers of 8 bytes, one after the other.
std::vector<std::byte> PreciseDriver::save() const {
  std::vector<double> numbers{time_, static_cast<double>(grid_steps_), proposed_step_, control_.previous(),
                              joints_closed_ ? 1.0 : 0.0};
  for (const std::int64_t n :
       {statistics_.steps, statistics_.rejected, statistics_.impacts, equations_.evaluations()}) {
    numbers.push_back(static_cast<double>(n));
  }
  numbers.insert(numbers.end(), y_.value().begin(), y_.value().end());
  numbers.insert(numbers.end(), y_.carry().begin(), y_.carry().end());
  const auto arcs = std::as_bytes(std::span(flight_.arcs()));
  const auto head = std::as_bytes(std::span(numbers));
  std::vector<std::byte> snapshot(head.begin(), head.end());
  snapshot.insert(snapshot.end(), arcs.begin(), arcs.end());
  return snapshot;
}

void PreciseDriver::restore(std::span<const std::byte> snapshot) {
  constexpr std::size_t kHead = 9;
  std::vector<double> numbers(kHead + 2 * y_.size());
  const std::size_t head_size = numbers.size() * sizeof(double);
  std::vector<Flight::Arc>& arcs = flight_.arcs();
  if (snapshot.size() != head_size + arcs.size() * sizeof(Flight::Arc)) {
    throw Error(Error::Kind::Value, "snapshot", "size", std::to_string(snapshot.size()),
                "is not of this scene and accuracy");
  }
  std::memcpy(numbers.data(), snapshot.data(), head_size);
  if (!arcs.empty()) std::memcpy(arcs.data(), snapshot.data() + head_size, arcs.size() * sizeof(Flight::Arc));
  time_ = numbers[0];
  grid_steps_ = static_cast<std::int64_t>(numbers[1]);
  proposed_step_ = numbers[2];
  control_.reset(numbers[3]);
  joints_closed_ = numbers[4] != 0;
  statistics_ = {static_cast<std::int64_t>(numbers[5]), static_cast<std::int64_t>(numbers[6]),
                 static_cast<std::int64_t>(numbers[7]), 0};
  equations_.set_evaluations(static_cast<std::int64_t>(numbers[8]));
  for (std::size_t i = 0; i < y_.size(); ++i) y_.set(i, numbers[kHead + i], numbers[kHead + y_.size() + i]);
}

}  // namespace plumb::precise
