#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb::demos {

/// Where an engine had a scene's bodies, on a grid of times from 0 on.
class SampledMotion {
 public:
  /// `dt`: s between samples.
  SampledMotion(double dt, std::size_t bodies) : dt_(dt), bodies_(bodies) {}

  struct Pose {
    double x, y, angle;
  };
  /// The next sample: a state for each body.
  void add(std::span<const BodyState> states);
  void assign(std::vector<Pose> poses) { poses_ = std::move(poses); }

  bool empty() const { return poses_.empty(); }
  const std::vector<Pose>& poses() const { return poses_; }
  double end() const;  ///< s, of the last sample

  /// Positions and angles at `time`, on straight lines between the samples; false beyond the end.
  bool at(double time, std::span<BodyState> out) const;

 private:
  double dt_;
  std::size_t bodies_;
  std::vector<Pose> poses_;
};

}  // namespace plumb::demos
