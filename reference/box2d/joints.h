#pragma once

#include <box2d/box2d.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <variant>

#include "engine/core/text.h"
#include "engine/joints/spring_mobility.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/scene.h"

/// A scene's joints in Box2D 2.4: those that it supports, with the same physical values.
namespace plumb::reference {

inline b2Vec2 to_box2d(Vec2d v) { return {static_cast<float>(v.x), static_cast<float>(v.y)}; }

/// Returns the index of the hinge between `body` and the world or a static body, which Box2D's gears need.
inline std::optional<std::size_t> fixed_hinge(const Scene& scene, const std::string& body) {
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const auto* hinge = std::get_if<RevoluteJoint>(&scene.joints[i]);
    if (hinge == nullptr || hinge->body_b != body) continue;
    const auto holder = find_body(scene, hinge->body_a);
    if (!holder || scene.bodies[*holder].type == BodyType::Static) return i;
  }
  return std::nullopt;
}

/// Gives the reason why Box2D does not support a joint; empty if it does.
class Box2dJointLimits {
 public:
  explicit Box2dJointLimits(const Scene& scene) : scene_(scene) {}

  std::string reason(const Joint& joint) const {
    return std::visit(
        [this](const auto& j) -> std::string {
          std::string why =
              j.break_force != 0 || j.break_torque != 0 ? "Box2D's joints do not break" : this->why(j);
          return why.empty() ? why : "joint " + plumb::quoted(j.name) + ": " + why;
        },
        joint);
  }

 private:
  static constexpr const char* kLevers =
      "Box2D's springs derive their stiffness from the masses alone; anchors off the centres of mass are not "
      "supported";

  std::string why(const RevoluteJoint& j) const {
    return j.spring ? "Box2D's revolute joint has no spring" : "";
  }
  std::string why(const DistanceJoint& j) const {
    if (static_cast<float>(j.length) < b2_linearSlop)
      return "length " + shortest(j.length) + " m is below Box2D's least, " +
             shortest(static_cast<double>(b2_linearSlop)) + " m";
    if (j.motor) return "Box2D's distance joint has no motor";
    return j.spring && !(j.anchor_a == Vec2d{} && j.anchor_b == Vec2d{}) ? kLevers : "";
  }
  std::string why(const PrismaticJoint& j) const {
    return j.spring ? "Box2D's prismatic joint has no spring" : "";
  }
  std::string why(const WeldJoint& j) const {
    return j.linear_spring ? "Box2D's weld is soft in the angle only" : "";
  }
  std::string why(const WheelJoint& j) const {
    return j.spring && !(j.anchor_a == Vec2d{} && j.anchor_b == Vec2d{}) ? kLevers : "";
  }
  std::string why(const MotorJoint&) const {
    return "Box2D's motor joint corrects a fraction of the offset per step; it has no spring";
  }
  std::string why(const MouseJoint& j) const { return j.anchor_b == Vec2d{} ? "" : kLevers; }
  std::string why(const GearJoint& j) const {
    for (const std::string& body : {j.body_a, j.body_b}) {
      if (!fixed_hinge(scene_, body))
        return "Box2D's gears need a hinge of each body (as its body_b) on a static body; " +
               plumb::quoted(body) + " has none";
    }
    const double off = angle(j.body_b) - j.ratio * angle(j.body_a) - j.phase;
    return std::abs(off) <= 1e-6 ? "" : "Box2D's gears keep their phase at the start";
  }
  std::string why(const PulleyJoint&) const { return ""; }
  std::string why(const RatchetJoint&) const { return "Box2D has no ratchet"; }
  std::string why(const FrictionJoint&) const { return ""; }

  double angle(const std::string& body) const { return scene_.bodies[*find_body(scene_, body)].angle; }

  const Scene& scene_;
};

/// Creates the joints. `body_called` returns the b2Body with a name.
template <class BodyCalled>
class Box2dJointMaker {
 public:
  Box2dJointMaker(b2World& world, const Scene& scene, BodyCalled body_called)
      : world_(world), scene_(scene), body_called_(body_called), made_(scene.joints.size()) {}

  /// Creates all joints of the scene; gears last, because they refer to other joints.
  void make_all() {
    for (const bool gears : {false, true}) {
      for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
        if (std::holds_alternative<GearJoint>(scene_.joints[i]) != gears) continue;
        made_[i] = std::visit([this](const auto& j) { return make(j); }, scene_.joints[i]);
      }
    }
  }

 private:
  static float narrow(double value) {
    constexpr double kMost = std::numeric_limits<float>::max();
    return static_cast<float>(std::fmin(std::fmax(value, -kMost), kMost));
  }

  template <class Def, class J>
  Def ends(const J& j) {
    Def def;
    def.bodyA = body_called_(j.body_a);
    def.bodyB = body_called_(j.body_b);
    def.collideConnected = j.collide;
    if constexpr (requires { def.localAnchorA, j.anchor_a; }) def.localAnchorA = to_box2d(j.anchor_a);
    if constexpr (requires { def.localAnchorB, j.anchor_b; }) def.localAnchorB = to_box2d(j.anchor_b);
    if constexpr (requires { def.referenceAngle, j.reference_angle; })
      def.referenceAngle = narrow(j.reference_angle);
    if constexpr (requires { def.localAxisA, j.axis; }) {
      def.localAxisA = to_box2d(j.axis);
      def.localAxisA.Normalize();
    }
    return def;
  }

  b2Joint* make(const RevoluteJoint& j) {
    auto def = ends<b2RevoluteJointDef>(j);
    if (j.limits) {
      def.enableLimit = true;
      def.lowerAngle = narrow(j.limits->lower), def.upperAngle = narrow(j.limits->upper);
    }
    if (j.motor) {
      def.enableMotor = true;
      def.motorSpeed = narrow(j.motor->speed), def.maxMotorTorque = narrow(j.motor->max_force);
    }
    return world_.CreateJoint(&def);
  }

  b2Joint* make(const DistanceJoint& j) {
    auto def = ends<b2DistanceJointDef>(j);
    // Without stiffness and with both limits at the length, Box2D solves it as an equation.
    def.length = def.minLength = def.maxLength = narrow(j.length);
    if (j.spring || j.range) {
      const Range range = j.range.value_or(Range{});
      def.minLength = narrow(std::fmax(range.lower, 0)), def.maxLength = narrow(range.upper);
    }
    if (j.spring) soften(def, *j.spring);
    return world_.CreateJoint(&def);
  }

  b2Joint* make(const PrismaticJoint& j) {
    auto def = ends<b2PrismaticJointDef>(j);
    limit_translation(def, j.limits);
    if (j.motor) {
      def.enableMotor = true;
      def.motorSpeed = narrow(j.motor->speed), def.maxMotorForce = narrow(j.motor->max_force);
    }
    return world_.CreateJoint(&def);
  }

  b2Joint* make(const WeldJoint& j) {
    auto def = ends<b2WeldJointDef>(j);
    if (j.angular_spring) {
      const auto arm = [](const b2Body* body, b2Vec2 anchor) {
        const b2Vec2 way = body->GetWorldVector(anchor - body->GetLocalCenter());
        return Vec2d{way.x, way.y};
      };
      soften(def, *j.angular_spring,
             angular_mobility(pair_of(def.bodyA, def.bodyB), arm(def.bodyA, def.localAnchorA),
                              arm(def.bodyB, def.localAnchorB)));
    }
    return world_.CreateJoint(&def);
  }

  b2Joint* make(const WheelJoint& j) {
    auto def = ends<b2WheelJointDef>(j);
    limit_translation(def, j.limits);
    if (j.motor) {
      def.enableMotor = true;
      def.motorSpeed = narrow(j.motor->speed), def.maxMotorTorque = narrow(j.motor->max_force);
    }
    if (j.spring) soften(def, *j.spring);
    return world_.CreateJoint(&def);
  }

  b2Joint* make(const MouseJoint& j) {
    auto def = ends<b2MouseJointDef>(j);
    def.target = def.bodyB->GetWorldPoint(to_box2d(j.anchor_b));  // grabs body b at its anchor
    def.maxForce = narrow(j.max_force);
    soften(def, j.spring);
    auto* mouse = static_cast<b2MouseJoint*>(world_.CreateJoint(&def));
    mouse->SetTarget(to_box2d(j.target));
    return mouse;
  }

  // angle_b - ratio angle_a = phase, as Box2D's coordinate1 + ratio coordinate2 = constant.
  b2Joint* make(const GearJoint& j) {
    auto def = ends<b2GearJointDef>(j);
    def.joint1 = made_[*fixed_hinge(scene_, j.body_b)];
    def.joint2 = made_[*fixed_hinge(scene_, j.body_a)];
    def.bodyA = def.joint1->GetBodyB(), def.bodyB = def.joint2->GetBodyB();
    def.ratio = narrow(-j.ratio);
    return world_.CreateJoint(&def);
  }

  b2Joint* make(const PulleyJoint& j) {
    auto def = ends<b2PulleyJointDef>(j);
    def.groundAnchorA = to_box2d(j.ground_a), def.groundAnchorB = to_box2d(j.ground_b);
    def.ratio = narrow(j.ratio);
    def.lengthA = b2Distance(def.bodyA->GetWorldPoint(def.localAnchorA), def.groundAnchorA);
    def.lengthB = b2Distance(def.bodyB->GetWorldPoint(def.localAnchorB), def.groundAnchorB);
    if (j.length) def.lengthB = (narrow(*j.length) - def.lengthA) / def.ratio;
    return world_.CreateJoint(&def);
  }

  b2Joint* make(const FrictionJoint& j) {
    auto def = ends<b2FrictionJointDef>(j);
    def.maxForce = narrow(j.max_force), def.maxTorque = narrow(j.max_torque);
    return world_.CreateJoint(&def);
  }

  b2Joint* make(const MotorJoint&) { return nullptr; }  // `Box2dJointLimits` refuses them
  b2Joint* make(const RatchetJoint&) { return nullptr; }

  static void limit_translation(auto& def, const std::optional<Range>& limits) {
    if (!limits) return;
    def.enableLimit = true;
    def.lowerTranslation = narrow(limits->lower), def.upperTranslation = narrow(limits->upper);
  }

  // Returns the bodies' inverse masses and inertias; 0 for static ones.
  static PairMobility<double> pair_of(const b2Body* a, const b2Body* b) {
    const auto inverse = [](float mass) { return mass > 0 ? 1.0 / mass : 0.0; };
    return {inverse(a->GetMass()), inverse(a->GetInertia()), inverse(b->GetMass()), inverse(b->GetInertia())};
  }

  // `mobility`: inverse of the effective mass that the spring's frequency refers to.
  static void soften(auto& def, const Spring& spring, double mobility) {
    const double omega = 2 * std::numbers::pi * spring.hertz, mass = mobility > 0 ? 1 / mobility : 0;
    def.stiffness = narrow(mass * omega * omega);
    def.damping = narrow(2 * spring.damping_ratio * mass * omega);
  }

  static void soften(auto& def, const Spring& spring) {
    b2LinearStiffness(def.stiffness, def.damping, narrow(spring.hertz), narrow(spring.damping_ratio),
                      def.bodyA, def.bodyB);
  }

  b2World& world_;
  const Scene& scene_;
  BodyCalled body_called_;
  std::vector<b2Joint*> made_;
};

}  // namespace plumb::reference
