#include "engine/joints/kind_of.h"

#include <variant>

namespace plumb {
namespace {

struct KindOf {
  JointKind operator()(const RevoluteJoint& j) const {
    return RevoluteDefinition{j.anchor_a, j.anchor_b, j.reference_angle, j.limits,
                              j.motor,    j.spring,   j.target_angle};
  }
  JointKind operator()(const DistanceJoint& j) const {
    return DistanceDefinition{j.anchor_a, j.anchor_b, j.length, j.spring, j.range, j.motor};
  }
  JointKind operator()(const PrismaticJoint& j) const {
    return PrismaticDefinition{j.anchor_a, j.anchor_b, j.axis,   j.reference_angle,
                               j.limits,   j.motor,    j.spring, j.target_translation};
  }
  JointKind operator()(const WeldJoint& j) const {
    return WeldDefinition{j.anchor_a, j.anchor_b, j.reference_angle, j.linear_spring, j.angular_spring};
  }
  JointKind operator()(const WheelJoint& j) const {
    return WheelDefinition{j.anchor_a, j.anchor_b, j.axis, j.spring, j.limits, j.motor};
  }
  JointKind operator()(const MotorJoint& j) const {
    return MotorDefinition{j.target_position, j.target_angle, j.max_force, j.max_torque, j.spring};
  }
  JointKind operator()(const MouseJoint& j) const {
    return MouseDefinition{j.anchor_b, j.target, j.spring, j.max_force};
  }
  JointKind operator()(const GearJoint& j) const { return GearDefinition{j.ratio, j.phase}; }
  JointKind operator()(const PulleyJoint& j) const {
    return PulleyDefinition{j.ground_a, j.ground_b, j.anchor_a, j.anchor_b, j.ratio, j.length};
  }
  JointKind operator()(const RatchetJoint& j) const { return RatchetDefinition{j.tooth, j.phase}; }
  JointKind operator()(const FrictionJoint& j) const {
    return FrictionDefinition{j.anchor_a, j.anchor_b, j.max_force, j.max_torque};
  }
};

}  // namespace

JointKind kind_of(const Joint& joint) { return std::visit(KindOf{}, joint); }

}  // namespace plumb
