#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb {

/// Initial error of a joint.
struct InitialJointError {
  std::string joint;
  bool is_angle = false;  ///< of an angle: rad and rad/s; else m and m/s
  double gap = 0;         ///< m or rad, by which the joint is open, too long or beyond its limit
  double speed = 0;       ///< velocity that violates its constraints
};

/// Returns the widest gap and the fastest speed of each joint that has a rigid constraint, or a limit that is
/// exceeded, in the scene's order; joints without any error are included. The scene is valid.
std::vector<InitialJointError> initial_joint_errors(const Scene& scene);

/// Describes the joints that are off by more than `gap` (m or rad) or `speed` (m/s or rad/s): "joint 'hip' is
/// off by 0.01 m where the scene starts".
std::vector<std::string> describe_joint_errors(const Scene& scene, double gap, double speed);

}  // namespace plumb
