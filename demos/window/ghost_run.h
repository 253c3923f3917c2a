#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "reference/backend.h"

namespace plumb::window {

/// How an engine moved a scene's bodies, on a grid of times.
class GhostRun {
 public:
  /// Lets the engine run, in a process of its own: a crash or a hang stays there.
  GhostRun(const Scene& scene, const reference::Backend& backend, const reference::StepSettings& settings,
           double duration);

  /// Why there is no motion, or with which settings it came about.
  const std::string& remark() const { return remark_; }
  bool known() const { return !poses_.empty(); }
  double end() const;  ///< s

  /// Positions and angles at `time`, on straight lines between the samples; false beyond the end.
  bool at(double time, std::span<BodyState> out) const;

 private:
  struct Pose {
    double x, y, angle;
  };
  double dt_;
  std::size_t bodies_;
  std::vector<Pose> poses_;
  std::string remark_;
};

}  // namespace plumb::window
