#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "engine/core/text.h"
#include "engine/precise/integration/integrator.h"
#include "engine/scene/error.h"

// Scales of the errors, and the first step that follows from them.
namespace plumb::precise {
namespace {

/// If only angles are integrated, errors of positions and velocities are not checked: instead, the bound on
/// angles is reduced to this fraction.
constexpr double kAngles = 0.5;

}  // namespace

/// Sets the unit of the error by component: the tolerance times the scene's length and speed (or a body's own
/// speed if that is larger), and times one radian.
void EventFreeIntegrator::set_error_scale() {
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const BodyState now = EquationsOfMotion::state(y_.value(), slot);
    const double speed = std::max(scales_.speed, std::sqrt(length_squared(now.velocity)));
    const double spin = std::max(scales_.speed / scales_.length, std::abs(now.angular_velocity));
    const double scale[EquationsOfMotion::kPerBody] = {scales_.length, scales_.length, 1, speed, speed, spin};
    for (std::size_t i = 0; i < EquationsOfMotion::kPerBody; ++i)
      all_.error_scale[EquationsOfMotion::kPerBody * slot + i] = tolerance_ * scale[i];
  }
  if (!uses_angles()) return;
  for (std::size_t link = 0; link < tree_.size(); ++link) {
    const double* scale = all_.error_scale.data() + EquationsOfMotion::kPerBody * tree_.slot(link);
    angles_.error_scale[link] = kAngles * scale[2];
    angles_.error_scale[tree_.width() + link] = kAngles * scale[5];
  }
}

/// Returns a tenth of the time in which any component changes by its scale.
double EventFreeIntegrator::first_step() const {
  double fastest = 0;
  const std::span<const double> rate = rate_at_start();
  for (std::size_t i = 0; i < rate.size(); ++i) {
    fastest = std::max(fastest, std::abs(rate[i]) * (tolerance_ / current().error_scale[i]));
  }
  const double eighth = std::sqrt(std::sqrt(std::sqrt(tolerance_)));  // the error is proportional to h^8
  return fastest > 0 ? std::min(std::max(0.1, eighth) / fastest, longest_step_) : longest_step_;
}

void EventFreeIntegrator::throw_step_underflow() const {
  std::size_t worst = 0;
  double fastest = -1;
  const std::span<const double> rate = rate_at_start();
  for (std::size_t i = 0; i < rate.size() && !std::isnan(fastest); ++i) {
    const double change = std::abs(rate[i]) / current().error_scale[i];
    if (change <= fastest) continue;
    worst = i;
    fastest = change;
  }
  const std::size_t slot =
      uses_angles() ? tree_.slot(worst % tree_.width()) : worst / EquationsOfMotion::kPerBody;
  const std::string subject = names_.empty() ? "the scene" : "body '" + names_[slot] + "'";
  if (!std::isfinite(fastest))
    throw Error(Error::Kind::Run, subject, "acceleration", shortest(fastest), "not finite");
  throw Error(Error::Kind::Run, subject, "step", shortest(proposed_step_) + " s",
              "the motion changes too fast for any step; a larger tolerance or Realtime may do");
}

}  // namespace plumb::precise
