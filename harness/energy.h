#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/truth_table.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

/// Energy, momentum and angular momentum of a system of bodies at one time.
struct Mechanics {
  double kinetic = 0;                 ///< J
  double potential = 0;               ///< J, in gravity, springs and attractions, from where each body starts
  Vec2d momentum{};                   ///< kg m/s
  double angular_momentum = 0;        ///< kg m^2/s, about the origin
  double sum_of_momenta = 0;          ///< kg m/s, sum of the bodies' |m v|
  double sum_of_angular_momenta = 0;  ///< kg m^2/s, sum of |m x * v| + |I w|
};

/// Sums over the dynamic bodies of `scene`.
Mechanics mechanics(const Scene& scene, std::span<const BodyState> states);

/// Scales of the drifts. They are taken from the truth if there is one, so that a diverging run does not
/// enlarge its own scale.
struct ConservationScale {
  double energy = 0;    ///< J, largest kinetic + potential energy, the potential from its lowest value
  double momentum = 0;  ///< kg m/s, largest sum of |m v|; total mass * extent / duration if that is 0
  double angular_momentum = 0;  ///< kg m^2/s; defined like that of momentum
};

ConservationScale conservation_scale(const Scene& scene, const TruthTable& truth);

/// Drift of energy, momentum and angular momentum from their initial values, relative to the scale. Absent
/// for quantities that the scene's physics does not conserve.
struct Drift {
  std::optional<double> energy, momentum, angular_momentum;
};

class DriftMeter {
 public:
  DriftMeter(const scenarios::Problem& problem, const ConservationScale& scale);
  Drift drift(std::span<const BodyState> states) const;

 private:
  const scenarios::Problem& problem_;
  ConservationScale scale_;
  Mechanics start_;
};

}  // namespace plumb::harness
