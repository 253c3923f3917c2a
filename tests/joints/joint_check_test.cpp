#include "engine/joints/joint_check.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/joints/joint_row.h"
#include "engine/scene/error.h"

namespace plumb {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_refused(const JointKind& kind, const std::string& subject, const std::string& field) {
  try {
    validate(kind);
    FAIL() << subject << " " << field << " was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
    EXPECT_EQ(error.subject(), subject);
    EXPECT_EQ(error.field(), field);
    EXPECT_FALSE(error.value().empty());
    EXPECT_FALSE(error.problem().empty());
  }
}

TEST(JointCheck, DefaultsAreAccepted) {
  for (const JointKind& kind :
       {JointKind{DistanceDefinition{}}, JointKind{RevoluteDefinition{}}, JointKind{PrismaticDefinition{}},
        JointKind{WeldDefinition{}}, JointKind{WheelDefinition{}}, JointKind{MotorDefinition{}},
        JointKind{MouseDefinition{}}, JointKind{GearDefinition{}}, JointKind{PulleyDefinition{}},
        JointKind{RatchetDefinition{}}, JointKind{FrictionDefinition{}}})
    EXPECT_NO_THROW(validate(kind)) << name_of(kind);
}

TEST(JointCheck, Distance) {
  const char* subject = "distance joint";
  expect_refused(DistanceDefinition{.anchor_a = {kNaN, 0}}, subject, "anchor_a.x");
  expect_refused(DistanceDefinition{.anchor_b = {0, kInfinity}}, subject, "anchor_b.y");
  expect_refused(DistanceDefinition{.length = 0}, subject, "length");
  expect_refused(DistanceDefinition{.length = kNaN}, subject, "length");
  expect_refused(DistanceDefinition{.spring = Spring{0, 1}}, subject, "spring.hertz");
  expect_refused(DistanceDefinition{.spring = Spring{1, -1}}, subject, "spring.damping_ratio");
  expect_refused(DistanceDefinition{.range = Range{2, 1}}, subject, "range.lower");
  expect_refused(DistanceDefinition{.range = Range{kNaN, 1}}, subject, "range.lower");
  expect_refused(DistanceDefinition{.range = Range{-2, -1}}, subject, "range.lower");
  expect_refused(DistanceDefinition{.range = Range{-1, 1}}, subject, "range.lower");
  expect_refused(DistanceDefinition{.range = Range{.upper = -1}}, subject, "range.upper");
  EXPECT_NO_THROW(validate(DistanceDefinition{.range = Range{.upper = 1}}));  // a rope
  expect_refused(DistanceDefinition{.range = Range{kInfinity, kInfinity}}, subject, "range.lower");
  expect_refused(DistanceDefinition{.range = Range{}, .motor = Motor{1, -1}}, subject, "motor.max_force");
  expect_refused(DistanceDefinition{.motor = Motor{1, 1}}, subject, "motor.speed");  // along a rod
}

TEST(JointCheck, RevolutePrismaticWeldWheel) {
  expect_refused(RevoluteDefinition{.anchor_a = {0, kNaN}}, "revolute joint", "anchor_a.y");
  expect_refused(RevoluteDefinition{.reference_angle = kNaN}, "revolute joint", "reference_angle");
  expect_refused(RevoluteDefinition{.limits = Range{1, -1}}, "revolute joint", "limits.lower");
  expect_refused(RevoluteDefinition{.motor = Motor{kNaN, 1}}, "revolute joint", "motor.speed");
  expect_refused(RevoluteDefinition{.spring = Spring{-1, 1}}, "revolute joint", "spring.hertz");
  expect_refused(RevoluteDefinition{.target_angle = kInfinity}, "revolute joint", "target_angle");
  expect_refused(PrismaticDefinition{.anchor_b = {kNaN, 0}}, "prismatic joint", "anchor_b.x");
  expect_refused(PrismaticDefinition{.axis = {0, 0}}, "prismatic joint", "axis");
  expect_refused(PrismaticDefinition{.axis = {kNaN, 0}}, "prismatic joint", "axis.x");
  expect_refused(PrismaticDefinition{.reference_angle = kNaN}, "prismatic joint", "reference_angle");
  expect_refused(PrismaticDefinition{.limits = Range{0, kNaN}}, "prismatic joint", "limits.upper");
  expect_refused(PrismaticDefinition{.motor = Motor{1, kNaN}}, "prismatic joint", "motor.max_force");
  expect_refused(PrismaticDefinition{.spring = Spring{1, kNaN}}, "prismatic joint", "spring.damping_ratio");
  expect_refused(PrismaticDefinition{.target_translation = kNaN}, "prismatic joint", "target_translation");
  expect_refused(WeldDefinition{.anchor_a = {kNaN, 0}}, "weld joint", "anchor_a.x");
  expect_refused(WeldDefinition{.reference_angle = kNaN}, "weld joint", "reference_angle");
  expect_refused(WeldDefinition{.linear_spring = Spring{0, 1}}, "weld joint", "linear_spring.hertz");
  expect_refused(WeldDefinition{.angular_spring = Spring{0, 1}}, "weld joint", "angular_spring.hertz");
  expect_refused(WheelDefinition{.axis = {0, 0}}, "wheel joint", "axis");
  expect_refused(WheelDefinition{.spring = Spring{kNaN, 1}}, "wheel joint", "spring.hertz");
  expect_refused(WheelDefinition{.limits = Range{1, 0}}, "wheel joint", "limits.lower");
  expect_refused(WheelDefinition{.motor = Motor{1, -1}}, "wheel joint", "motor.max_force");
}

TEST(JointCheck, Others) {
  expect_refused(MotorDefinition{.target_position = {kNaN, 0}}, "motor joint", "target_position.x");
  expect_refused(MotorDefinition{.target_angle = kNaN}, "motor joint", "target_angle");
  expect_refused(MotorDefinition{.max_force = -1}, "motor joint", "max_force");
  expect_refused(MotorDefinition{.max_torque = -1}, "motor joint", "max_torque");
  expect_refused(MotorDefinition{.spring = {0, 1}}, "motor joint", "spring.hertz");
  expect_refused(MouseDefinition{.anchor_b = {kNaN, 0}}, "mouse joint", "anchor_b.x");
  expect_refused(MouseDefinition{.target = {0, kNaN}}, "mouse joint", "target.y");
  expect_refused(MouseDefinition{.max_force = kNaN}, "mouse joint", "max_force");
  expect_refused(GearDefinition{.ratio = 0}, "gear joint", "ratio");
  expect_refused(GearDefinition{.phase = kNaN}, "gear joint", "phase");
  expect_refused(PulleyDefinition{.ground_a = {kNaN, 0}}, "pulley joint", "ground_a.x");
  expect_refused(PulleyDefinition{.ground_b = {kNaN, 0}}, "pulley joint", "ground_b.x");
  expect_refused(PulleyDefinition{.ratio = 0}, "pulley joint", "ratio");
  expect_refused(PulleyDefinition{.ratio = -1}, "pulley joint", "ratio");
  expect_refused(PulleyDefinition{.length = 0}, "pulley joint", "length");
  expect_refused(RatchetDefinition{.tooth = 0}, "ratchet joint", "tooth");
  expect_refused(RatchetDefinition{.phase = kNaN}, "ratchet joint", "phase");
  expect_refused(FrictionDefinition{.anchor_a = {kNaN, 0}}, "friction joint", "anchor_a.x");
  expect_refused(FrictionDefinition{.max_force = -1}, "friction joint", "max_force");
  expect_refused(FrictionDefinition{.max_torque = kInfinity}, "friction joint", "max_torque");
}

TEST(JointCheck, UnitKeepsTheDirectionOfAnyAxis) {
  for (const double scale : {1e-300, 1.0, 1e15}) {
    const Vec2d n = unit({3 * scale, -4 * scale});
    EXPECT_DOUBLE_EQ(n.x, 0.6);
    EXPECT_DOUBLE_EQ(n.y, -0.8);
  }
}

}  // namespace
}  // namespace plumb
