#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb::demos {

/// Poses of a scene's bodies as an engine computed them, on a grid of times from 0 on.
class SampledMotion {
 public:
  /// `dt`: s between samples.
  SampledMotion(double dt, std::size_t bodies) : dt_(dt), bodies_(bodies) {}

  struct Pose {
    double x, y, angle;
  };
  /// Appends a sample: a state for each body.
  void add(std::span<const BodyState> states);
  void assign(std::vector<Pose> poses) { poses_ = std::move(poses); }

  bool empty() const { return poses_.empty(); }
  const std::vector<Pose>& poses() const { return poses_; }
  double end() const;  ///< s, of the last sample

  /// Interpolates positions and angles at `time` linearly between the samples; false beyond the end.
  bool at(double time, std::span<BodyState> out) const;

 private:
  double dt_;
  std::size_t bodies_;
  std::vector<Pose> poses_;
};

}  // namespace plumb::demos
