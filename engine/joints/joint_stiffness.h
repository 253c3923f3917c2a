#pragma once

namespace plumb {

/// Constants of a joint's springs, 0 where it has none. A damped spring pulls with -(k C + c dC/dt), C its
/// coordinate's distance from the target.
struct JointStiffness {
  double linear = 0;           ///< N/m
  double angular = 0;          ///< N m/rad
  double linear_damping = 0;   ///< N s/m
  double angular_damping = 0;  ///< N m s/rad
};

}  // namespace plumb
