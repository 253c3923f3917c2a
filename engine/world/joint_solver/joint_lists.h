#pragma once

#include <array>
#include <iterator>
#include <tuple>
#include <variant>
#include <vector>

#include "engine/joints/distance_joint.h"
#include "engine/joints/friction_joint.h"
#include "engine/joints/gear_joint.h"
#include "engine/joints/motor_joint.h"
#include "engine/joints/mouse_joint.h"
#include "engine/joints/prismatic_joint.h"
#include "engine/joints/weld_joint.h"
#include "engine/joints/wheel_joint.h"
#include "engine/world/joint_solver/joint_constraint.h"

namespace plumb {

/// Number of joint colours. One more list is the overflow, solved in order; the last one holds inactive
/// joints.
inline constexpr int kJointColours = 24;
inline constexpr int kOverflowColour = kJointColours, kInactiveColour = kJointColours + 1;

/// Form in which a joint is solved. Two kinds have a plain form and a general one.
enum JointForm : int {
  kHinge,
  kDistance,
  kRevolute,
  kPrismatic,
  kWeld,
  kSoftWeld,
  kWheel,
  kMotor,
  kMouse,
  kGear,
  kPulley,
  kRatchet,
  kFriction,
  kForms
};

inline JointForm form_of(const JointKind& definition) {
  static constexpr JointForm kByKind[] = {kDistance, kRevolute, kPrismatic, kWeld,    kWheel,   kMotor,
                                          kMouse,    kGear,     kPulley,    kRatchet, kFriction};
  static_assert(std::size(kByKind) == std::variant_size_v<JointKind>);
  if (const auto* revolute = std::get_if<RevoluteDefinition>(&definition))
    return revolute->limits || revolute->motor || revolute->spring ? kRevolute : kHinge;
  if (const auto* weld = std::get_if<WeldDefinition>(&definition))
    return weld->linear_spring || weld->angular_spring ? kSoftWeld : kWeld;
  return kByKind[definition.index()];
}

/// One list per colour, for joints of one form.
template <class Constraint>
using JointLists = std::array<std::vector<Constraint>, kJointColours + 2>;

/// Lists by form.
template <class Real, template <class> class... Kinds>
using ListsOfKinds = std::tuple<JointLists<JointConstraint<Real, Kinds>>...>;
template <class Real>
using JointStore =
    ListsOfKinds<Real, HingeRows, DistanceRows, RevoluteRows, PrismaticRows, WeldRows, SoftWeldRows,
                 WheelRows, MotorRows, MouseRows, GearRows, PulleyRows, RatchetRows, FrictionRows>;

}  // namespace plumb
