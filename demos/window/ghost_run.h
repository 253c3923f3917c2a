#pragma once

#include <string>

#include "demos/compared/sampled_motion.h"
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
  bool known() const { return !motion_.empty(); }
  const demos::SampledMotion& motion() const { return motion_; }

 private:
  demos::SampledMotion motion_;
  std::string remark_;
};

}  // namespace plumb::window
