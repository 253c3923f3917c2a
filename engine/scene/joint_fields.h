#pragma once

#include <limits>
#include <type_traits>

#include "engine/scene/joint.h"
#include "engine/scene/limits.h"

/// Names and allowed values of each joint's fields. This is the only list: reading, writing and validation
/// use it, for joints of a scene and for definitions of a world's joints. `visit(name, member, rule)` is
/// called for each field in order.
namespace plumb {

/// Rule of a number, or of each component of a vector.
struct FieldRule {
  Limits limits = Limits::Any;
  const char* unit = "";
  bool required = false;
  /// Value that means "none": allowed beside those within the limits, and left out of JSON. NaN: there is no
  /// such value.
  double none = std::numeric_limits<double>::quiet_NaN();
};

/// True if J is the Kind of joint, either as a part of a scene or as a joint's definition.
template <class J, class Kind>
concept Is = std::is_same_v<std::remove_cvref_t<J>, Kind> ||
    std::is_same_v<typename std::remove_cvref_t<J>::SceneJoint, Kind>;

/// Visits the numbers of a spring, a motor or a range. `rule` is that of the joint's field.
template <Is<Spring> S, class Visit>
void inner_fields(S& s, const FieldRule&, Visit&& visit) {
  visit("hertz", s.hertz, FieldRule{Limits::Positive, "1/s", true});
  visit("damping_ratio", s.damping_ratio, FieldRule{Limits::NonNegative, ""});
}

template <Is<Motor> M, class Visit>
void inner_fields(M& m, const FieldRule& rule, Visit&& visit) {
  visit("speed", m.speed, FieldRule{Limits::Any, rule.unit});
  visit("max_force", m.max_force, FieldRule{Limits::NonNegative, "N or N m", true});
}

template <Is<Range> R, class Visit>
void inner_fields(R& r, const FieldRule& rule, Visit&& visit) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  visit("lower", r.lower, FieldRule{rule.limits, rule.unit, false, -kInfinity});
  visit("upper", r.upper, FieldRule{rule.limits, rule.unit, false, kInfinity});
}

/// Visits the anchors, if there are any.
template <class J, class Visit>
void anchor_fields(J& j, Visit&& visit) {
  constexpr FieldRule kPlace{Limits::Any, "m"};
  if constexpr (requires { j.anchor_a; }) visit("anchor_a", j.anchor_a, kPlace);
  if constexpr (requires { j.anchor_b; }) visit("anchor_b", j.anchor_b, kPlace);
}

/// Visits the fields common to all joints, which follow each joint's own.
template <class J, class Visit>
void last_fields(J& j, Visit&& visit) {
  visit("collide", j.collide, FieldRule{});
  visit("break_force", j.break_force, FieldRule{Limits::NonNegative, "N"});
  visit("break_torque", j.break_torque, FieldRule{Limits::NonNegative, "N m"});
}

template <Is<RevoluteJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("reference_angle", j.reference_angle, FieldRule{Limits::Any, "rad"});
  visit("limits", j.limits, FieldRule{Limits::Any, "rad"});
  visit("motor", j.motor, FieldRule{Limits::Any, "rad/s"});
  visit("spring", j.spring, FieldRule{});
  visit("target_angle", j.target_angle, FieldRule{Limits::Any, "rad"});
}

template <Is<DistanceJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("length", j.length, FieldRule{Limits::Positive, "m", true});
  visit("spring", j.spring, FieldRule{});
  visit("range", j.range, FieldRule{Limits::NonNegative, "m"});
  visit("motor", j.motor, FieldRule{Limits::Any, "m/s"});
}

template <Is<PrismaticJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("axis", j.axis, FieldRule{Limits::NotZero, "m"});
  visit("reference_angle", j.reference_angle, FieldRule{Limits::Any, "rad"});
  visit("limits", j.limits, FieldRule{Limits::Any, "m"});
  visit("motor", j.motor, FieldRule{Limits::Any, "m/s"});
  visit("spring", j.spring, FieldRule{});
  visit("target_translation", j.target_translation, FieldRule{Limits::Any, "m"});
}

template <Is<WeldJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("reference_angle", j.reference_angle, FieldRule{Limits::Any, "rad"});
  visit("linear_spring", j.linear_spring, FieldRule{});
  visit("angular_spring", j.angular_spring, FieldRule{});
}

template <Is<WheelJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("axis", j.axis, FieldRule{Limits::NotZero, "m"});
  visit("spring", j.spring, FieldRule{});
  visit("limits", j.limits, FieldRule{Limits::Any, "m"});
  visit("motor", j.motor, FieldRule{Limits::Any, "rad/s"});
}

template <Is<MotorJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("target_position", j.target_position, FieldRule{Limits::Any, "m"});
  visit("target_angle", j.target_angle, FieldRule{Limits::Any, "rad"});
  visit("max_force", j.max_force, FieldRule{Limits::NonNegative, "N"});
  visit("max_torque", j.max_torque, FieldRule{Limits::NonNegative, "N m"});
  visit("spring", j.spring, FieldRule{});
}

template <Is<MouseJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("target", j.target, FieldRule{Limits::Any, "m", true});
  visit("spring", j.spring, FieldRule{});
  visit("max_force", j.max_force, FieldRule{Limits::NonNegative, "N", true});
}

template <Is<GearJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("ratio", j.ratio, FieldRule{Limits::NotZero, ""});
  visit("phase", j.phase, FieldRule{Limits::Any, "rad"});
}

template <Is<PulleyJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("ground_a", j.ground_a, FieldRule{Limits::Any, "m", true});
  visit("ground_b", j.ground_b, FieldRule{Limits::Any, "m", true});
  visit("ratio", j.ratio, FieldRule{Limits::Positive, ""});
  visit("length", j.length, FieldRule{Limits::Positive, "m"});
}

template <Is<RatchetJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("tooth", j.tooth, FieldRule{Limits::NotZero, "rad"});
  visit("phase", j.phase, FieldRule{Limits::Any, "rad"});
}

template <Is<FrictionJoint> J, class Visit>
void own_fields(J& j, Visit&& visit) {
  visit("max_force", j.max_force, FieldRule{Limits::NonNegative, "N"});
  visit("max_torque", j.max_torque, FieldRule{Limits::NonNegative, "N m"});
}

}  // namespace plumb
