#pragma once

#include <string>

#include "demos/compared/sampled_motion.h"
#include "engine/scene/scene.h"
#include "reference/backend.h"

namespace plumb::window {

/// Motion of a scene's bodies as an engine computed it, on a grid of times.
class GhostRun {
 public:
  /// Runs the engine in a process of its own, so that it may crash or hang.
  GhostRun(const Scene& scene, const reference::Backend& backend, const reference::StepSettings& settings,
           double duration);

  /// Returns the reason if there is no motion, else the settings of the run.
  const std::string& remark() const { return remark_; }
  bool known() const { return !motion_.empty(); }
  const demos::SampledMotion& motion() const { return motion_; }

 private:
  demos::SampledMotion motion_;
  std::string remark_;
};

}  // namespace plumb::window
