#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb {

/// How far off a joint is where its scene starts.
struct JointStart {
  std::string joint;
  bool turns = false;  ///< of an angle: rad and rad/s; else m and m/s
  double gap = 0;      ///< how far it is open, too long or beyond its limit
  double speed = 0;    ///< how fast its bodies move against what it holds
};

/// The widest gap and the fastest speed of each joint that holds something rigid, or has a limit that is
/// passed, in the scene's order; joints that are neither open nor moving are among them. The scene is valid.
std::vector<JointStart> joint_starts(const Scene& scene);

/// The same in words, by joint, of those that are off by more than `gap` (m or rad) or `speed` (m/s or
/// rad/s): "joint 'hip' is off by 0.01 m where the scene starts".
std::vector<std::string> joint_complaints(const Scene& scene, double gap, double speed);

}  // namespace plumb
