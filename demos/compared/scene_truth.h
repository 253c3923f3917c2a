#pragma once

#include <optional>
#include <span>
#include <vector>

#include "demos/core/demo.h"
#include "engine/geometry/aabb.h"
#include "scenarios/scenario.h"

namespace plumb::demos {

/// Reference of a displayed scene: the exact motion, which no engine computed, and its energy.
class SceneTruth {
 public:
  explicit SceneTruth(scenarios::Problem problem);

  const Scene& scene() const { return problem_.scene; }
  bool known() const { return static_cast<bool>(problem_.truth.exact); }
  /// Source of the truth; "" if it is unknown.
  const std::string& source() const { return problem_.truth.source; }
  /// Returns the duration of other engines' runs, s: the scenario's own, and at least 10 s.
  double end() const;

  /// Computes the exact states at `time`; false if they are unknown, or beyond the scenario's duration. A
  /// truth holds only for that duration: afterwards a ball may hit another wall.
  bool at(double time, std::span<BodyState> out) const;

  /// Returns the energy (J), its drift relative to the truth's largest kinetic energy, and the largest errors
  /// of position (m) and angle (rad) over the bodies. Leaves out those without a meaning for this scene.
  std::vector<Figure> figures(double time, std::span<const BodyState> states) const;

  /// Draws the true paths of the moving bodies if there are few.
  void draw_paths(DebugDraw& out) const;

  /// Returns the box around the true motion, with a margin, m. Returns nullopt if the truth is unknown, or if
  /// bodies would be mere specks in the box: then a camera that follows them is better.
  std::optional<Aabb<double>> view() const;

 private:
  double energy_of(std::span<const BodyState> states) const;

  scenarios::Problem problem_;
  double start_ = 0, energy_scale_ = 0;              // J
  mutable std::vector<std::vector<Vec2d>> paths_{};  // m; computed when first drawn
};

/// Returns the largest distance over the bodies, m.
double largest_distance(std::span<const BodyState> a, std::span<const BodyState> b);

}  // namespace plumb::demos
