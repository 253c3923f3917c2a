#include "engine/precise/invariants.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb::precise {
namespace {

/// Number of steps whose errors together equal the tolerance: each step's error is a thousandth of it.
constexpr double kSteps = 1000;
/// Allowed error of a step's balance, in roundings of a position, a speed or the work.
constexpr double kBalanceRoundings = 16;

}  // namespace

Invariants::Invariants(const Scene& scene, const ScenePartition& partition, const Precise& precise,
                       EquationsOfMotion& equations)
    : equations_(equations), gravity_(scene.gravity), tolerance_(precise.tolerance) {
  const Scales scales = scales_of(scene, partition);
  length_ = scales.length;
  speed_ = scales.speed;
}

double Invariants::bound() const {
  return tolerance_ * max_energy_ * (1 + static_cast<double>(steps_) / kSteps) +
         kBalanceRoundings * std::numeric_limits<double>::epsilon() * std::sqrt(rounding_);
}

void Invariants::account(const EventFreeIntegrator& motion) {
  const std::optional<double> work = motion.work();
  if (!work || equations_.constraints_do_work()) return;
  double gained = 0, size = 0, rounding = std::abs(*work);
  for (std::size_t slot = 0; slot < equations_.bodies().size(); ++slot) {
    const std::size_t body = equations_.bodies()[slot];
    const BodyState from = EquationsOfMotion::state(motion.state_at_start().value(), slot),
                    to = EquationsOfMotion::state(motion.state().value(), slot);
    if (!(equations_.inverse_mass(body) > 0)) continue;
    const double mass = 1 / equations_.inverse_mass(body);
    const double v2 = std::max(length_squared(from.velocity), length_squared(to.velocity));
    gained += 0.5 * mass * dot(to.velocity - from.velocity, to.velocity + from.velocity) -
              mass * dot(gravity_, to.position - from.position);
    size += mass * std::max(v2, speed_ * speed_);
    rounding += mass * (v2 + std::abs(gravity_.x * to.position.x) + std::abs(gravity_.y * to.position.y));
    if (!(equations_.inverse_inertia(body) > 0)) continue;
    const double inertia = 1 / equations_.inverse_inertia(body), own = speed_ / length_;
    const double w2 =
        std::max(from.angular_velocity * from.angular_velocity, to.angular_velocity * to.angular_velocity);
    gained += 0.5 * inertia * (to.angular_velocity - from.angular_velocity) *
              (to.angular_velocity + from.angular_velocity);
    size += inertia * std::max(w2, own * own);
    rounding += inertia * w2;
  }
  ++steps_;
  max_energy_ = std::max(max_energy_, size);
  rounding_ += rounding * rounding;
  drift_ += gained - *work;
  if (std::abs(drift_) <= bound()) return;
  throw Error(Error::Kind::Run, "the scene", "energy", shortest(drift_) + " J",
              std::string(drift_ > 0 ? "came up" : "was lost") + " without work, more than the " +
                  shortest(bound()) + " J that tolerance " + shortest(tolerance_) +
                  " allows by then: the motion has left its path; try another tolerance, or Realtime");
}

void Invariants::save(SnapshotWriter& out) const {
  out.put(drift_);
  out.put(max_energy_);
  out.put(rounding_);
  out.put(steps_);
}

void Invariants::restore(SnapshotReader& in) {
  drift_ = in.get<double>();
  max_energy_ = in.get<double>();
  rounding_ = in.get<double>();
  steps_ = in.get<std::int64_t>();
}

}  // namespace plumb::precise
