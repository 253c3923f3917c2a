#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reference/backend.h"

namespace plumb::harness::sweep {

/// Ladder of steps: 1/15 s, and each rung half of the one before. Samples of a coarser step coincide with
/// samples of a finer one, so that errors are maxima over comparable instants.
struct Ladder {
  double coarsest = 1.0 / 15;  ///< s
  int rungs = 11;              ///< to 1/15360 s

  double dt(int rung) const;
};

/// Returns the distance between samples in s, for a step of `ladder`: the step, but at least 1/240 s. Finer
/// steps are sampled every few steps.
double sample_interval(double dt);

/// Settings that a sweep may choose for an engine: a step of the ladder times the values of its knobs.
/// Engines with a tolerance use the three coarsest steps, which are only their sampling grid.
class Space {
 public:
  /// One index per axis; the first axis is dt, then the engine's knobs.
  using Place = std::vector<int>;

  Space(const reference::Backend& backend, const Ladder& ladder);

  reference::StepSettings settings(const Place& place) const;
  /// Returns the place of `settings`, if they are in the space.
  std::optional<Place> find(const reference::StepSettings& settings) const;

  /// Returns the engine's defaults at the step of the ladder nearest to 1/60 s.
  Place start() const;
  /// Returns the starting points: the defaults at steps over the whole ladder, `start` first.
  std::vector<Place> seeds() const;

  struct Neighbour {
    Place place;
    int axis;
    double cost_factor;  ///< expected ratio of the costs
  };
  /// Returns the places that differ in one axis: by one step of the ladder or one numeric value up or down,
  /// or by any other of unordered values.
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

/// Formats settings for people and as a name: "dt 1/240, substeps 4, integrator velocity_verlet".
std::string settings_text(const reference::StepSettings& settings);

}  // namespace plumb::harness::sweep
