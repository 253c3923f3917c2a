#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reference/backend.h"

namespace plumb::harness::sweep {

/// The ladder of steps: 1/15 s, and each rung half of the one before. Samples of a coarser step lie on those
/// of a finer one, so that errors are maxima over comparable instants.
struct Ladder {
  double coarsest = 1.0 / 15;  ///< s
  int rungs = 11;              ///< to 1/15360 s

  double dt(int rung) const;
};

/// Samples of a run of a sweep are a step apart, but not nearer than 1/240 s: finer steps are sampled every
/// few steps. In s, for a step of `ladder`.
double sample_interval(double dt);

/// All settings that a sweep may choose for an engine: a step of the ladder times the values of its knobs.
/// Engines with a tolerance use the three coarsest steps, which are only their sampling grid.
class Space {
 public:
  /// An index an axis; the first axis is dt, then the engine's knobs.
  using Place = std::vector<int>;

  Space(const reference::Backend& backend, const Ladder& ladder);

  reference::StepSettings settings(const Place& place) const;
  /// Where `settings` stand, if they are one of these.
  std::optional<Place> find(const reference::StepSettings& settings) const;

  /// The engine's defaults at the rung nearest to 1/60 s.
  Place start() const;
  /// Places to begin from: the defaults at steps all over the ladder, `start` first.
  std::vector<Place> seeds() const;

  struct Neighbour {
    Place place;
    int axis;
    double cost_factor;  ///< how many times as expensive it should be
  };
  /// One rung or one value up or down, or any other kind.
  std::vector<Neighbour> neighbours(const Place& place) const;

  int axes() const { return 1 + static_cast<int>(knobs_.size()); }
  int size(int axis) const;

 private:
  double cost_of(int axis, int index) const;

  Ladder ladder_;
  bool adaptive_ = false;
  std::vector<reference::Knob> knobs_;
  Place start_;
};

/// For people and as a name: "dt 1/240, substeps 4, integrator velocity_verlet".
std::string settings_text(const reference::StepSettings& settings);

}  // namespace plumb::harness::sweep
