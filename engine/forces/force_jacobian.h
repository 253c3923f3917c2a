#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/forces/formula_force.h"
#include "engine/forces/formula_spring.h"
#include "engine/joints/row.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Derivatives of the wrench on one body (force x, y and torque) with respect to the motion of a body, often
/// the same one: position x, y and angle; velocity x, y and angular velocity.
struct ForceBlock {
  std::size_t on = 0, by = 0;  // bodies
  double position[3][3] = {};
  double velocity[3][3] = {};
};

/// The derivatives of a scene's force laws, each from its formula.
class ForceJacobian {
 public:
  /// The scene is valid.
  explicit ForceJacobian(const Scene& scene);

  /// Computes the blocks at `time`; the bodies they couple do not depend on the motion.
  void evaluate(double time, std::span<const Pose<double>> poses, std::span<const Twist<double>> twists,
                std::vector<ForceBlock>& out) const;

 private:
  struct Law {
    ForceLaw law;
    int bodies[2] = {kFixedFrame, kFixedFrame};
    double mass = 0;  ///< kg, of the first body
    FormulaForceLaw force{};
    FormulaSpringLaw spring{};
  };
  std::vector<Law> laws_;
};

}  // namespace plumb
