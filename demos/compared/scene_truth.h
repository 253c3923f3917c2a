#pragma once

#include <optional>
#include <span>
#include <vector>

#include "demos/core/demo.h"
#include "engine/geometry/aabb.h"
#include "scenarios/scenario.h"

namespace plumb::demos {

/// What a scene that is shown is held against: the motion that no engine computed, and its energy.
class SceneTruth {
 public:
  explicit SceneTruth(scenarios::Problem problem);

  const Scene& scene() const { return problem_.scene; }
  bool known() const { return static_cast<bool>(problem_.truth.exact); }
  /// Where it comes from; "" where it is not known.
  const std::string& source() const { return problem_.truth.source; }
  /// s, how far other engines are asked to go: the scenario's own duration, and 10 s at least.
  double end() const;

  /// The exact states at `time`; false beyond `end` and where they are not known.
  bool at(double time, std::span<BodyState> out) const;

  /// Energy (J), its drift relative to the truth's largest kinetic energy, and the largest errors of position
  /// (m) and angle (rad) over the bodies; those that mean something for this scene.
  std::vector<Figure> figures(double time, std::span<const BodyState> states) const;

  /// What the truth goes through, with some room around it, m; nothing where it is not known.
  std::optional<Aabb<double>> view() const;

 private:
  double energy_of(std::span<const BodyState> states) const;

  scenarios::Problem problem_;
  double start_ = 0, energy_scale_ = 0;  // J
};

/// m, the largest over the bodies.
double largest_distance(std::span<const BodyState> a, std::span<const BodyState> b);

}  // namespace plumb::demos
