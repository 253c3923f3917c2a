#include "engine/precise/integration/symplectic.h"

#include <algorithm>
#include <limits>
#include <variant>

#include "engine/precise/dynamics/scene_partition.h"
#include "engine/scene/error.h"

namespace plumb::precise {
namespace {

/// Lengths of the stages, as fractions of the step: kGamma, then kMiddle, then kGamma in reverse.
constexpr int kHalf = 8;
constexpr double kGamma[kHalf] = {0.13020248308889008087881763,  0.56116298177510838456196441,
                                  -0.38947496264484728640807860, 0.15884190655515560089621075,
                                  -0.39590389413323757733623154, 0.18453964097831570709183254,
                                  0.25837438768632204729397911,  0.29501172360931029887096624};
constexpr double kMiddle = -0.60550853383003451169892108;

}  // namespace

SymplecticMotion::SymplecticMotion(EquationsOfMotion& equations)
    : equations_(equations), acceleration_(equations.body_count()), correction_(equations.body_count()) {}

void SymplecticMotion::step(double time, double h, Compensated& y) {
  equations_.free_accelerations(time, y.value(), acceleration_);
  equations_.factorise_joints(time, y.value());
  double at = 0;
  const auto go = [&](double gamma) {
    stage(time + at * h, gamma * h, y);
    at += gamma;
  };
  for (int i = 0; i < kHalf; ++i) go(kGamma[i]);
  go(kMiddle);
  for (int i = kHalf; i-- > 0;) go(kGamma[i]);
}

/// Makes one RATTLE step. Changes velocities by half the accelerations, moves with the joint impulses that
/// close the joints at the end, then adds the other half with the impulses that keep the joints closed.
/// Starts with the accelerations and the Jacobian at y, and ends with those at the new y.
void SymplecticMotion::stage(double time, double h, Compensated& y) {
  kick(0.5 * h, acceleration_, y);
  drift(time, h, y);
  equations_.free_accelerations(time + h, y.value(), acceleration_);
  kick(0.5 * h, acceleration_, y);
  equations_.factorise_joints(time + h, y.value());
  equations_.velocity_correction(y.value(), correction_);
  kick(1, correction_, y);
}

/// Sets q += h v, then q += M^-1 J^T lambda with J at the start until C(q) = 0, and corrects v accordingly.
void SymplecticMotion::drift(double time, double h, Compensated& y) {
  constexpr int kMaxIterations = 50;
  const std::span<const std::size_t> bodies = equations_.bodies();
  for (std::size_t slot = 0; slot < bodies.size(); ++slot) {
    for (std::size_t i = 0; i < 3; ++i)
      y.add(EquationsOfMotion::kPerBody * slot + i, h * y[EquationsOfMotion::kPerBody * slot + 3 + i]);
  }
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxIterations; ++i) {
    const double gap = equations_.position_correction(time + h, y.value(), correction_);
    if (gap == 0 || (gap >= 0.5 * before && gap <= equations_.rounding_of_gaps())) return;
    before = gap;
    for (std::size_t slot = 0; slot < bodies.size(); ++slot) {
      const Twist<double>& p = correction_[bodies[slot]];
      y.add(EquationsOfMotion::kPerBody * slot, p.velocity.x);
      y.add(EquationsOfMotion::kPerBody * slot + 1, p.velocity.y);
      y.add(EquationsOfMotion::kPerBody * slot + 2, p.angular_velocity);
    }
    kick(1 / h, correction_, y);
  }
  throw Error(
      Error::Kind::Run, "precise", "step", "",
      "joints cannot be held by the symplectic method at its step; a smaller tolerance makes it shorter");
}

void SymplecticMotion::kick(double scale, std::span<const Twist<double>> change, Compensated& y) const {
  equations_.add_velocities(change, scale, y);
}

}  // namespace plumb::precise
