#pragma once

#include "engine/joints/definitions.h"
#include "engine/joints/joint_stiffness.h"
#include "engine/joints/spring_mobility.h"
#include "engine/math/pose.h"

/// Constant stiffness of the springs of joints: k = m w^2 and c = 2 zeta m w, w = 2 pi hertz, where m is the
/// effective mass at the pose in which the joint was created. With an m of the present pose the force would
/// have no potential, and an undamped spring could gain energy (docs/decisions/constant-springs.md).
namespace plumb {

/// Pose of body b in the frame of body a at which the effective masses of a joint's springs are taken.
struct JointReference {
  Vec2d offset{};               ///< m, of b's origin from a's
  Rotation<double> rotation{};  ///< of b relative to a
};

/// Returns the present pose of b relative to a. Positions are of the centres of mass, m; `centre_a` and
/// `centre_b` are these in the bodies' frames, m.
JointReference reference_of(const Pose<double>& a, Vec2d centre_a, const Pose<double>& b, Vec2d centre_b);

/// Mobilities (1 / effective mass) that the springs of a joint refer to; 0: the spring moves nothing.
struct SpringMobility {
  double angular = 0;  ///< 1/(kg m^2), of the angle
  double axial = 0;    ///< 1/kg, of the first coordinate along an axis or a line
  double point = 0;    ///< 1/kg, of a point: the inverse of its effective mass averaged over all directions
};

/// Returns them at `reference`. A spring beside rigid rows of the joint has the mobility that these leave; a
/// point's spring pulls along the gap with one stiffness in all directions.
SpringMobility spring_mobility(const JointKind& definition, const JointReference& reference, Vec2d centre_a,
                               Vec2d centre_b, const PairMobility<double>& bodies);

/// Stiffness and damping of a spring.
struct SpringConstants {
  double stiffness = 0;  ///< N/m or N m/rad
  double damping = 0;    ///< N s/m or N m s/rad
};

/// Returns those of a spring that refers to `mobility`; 0 if it moves nothing.
SpringConstants spring_constants(const Spring& spring, double mobility);

/// Returns the constants of a joint's springs. Throws Error (Unsupported) for a joint without any.
JointStiffness joint_stiffness(const JointKind& definition, const SpringMobility& mobility);

}  // namespace plumb
