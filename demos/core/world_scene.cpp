#include "demos/core/world_scene.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "engine/world/definitions.h"

namespace plumb::demos {
namespace {

// Returns the centre of mass in the body's frame. It is the origin of the frame that scenes use.
Vec2d local_centre(const DemoWorld& world, BodyId body) {
  return world.local_point(body, world.centre(body));
}

class Names {
 public:
  std::string unique(const std::string& wanted, const char* otherwise) {
    const std::string stem = wanted.empty() || wanted == kWorld ? otherwise : wanted;
    std::string name = stem;
    for (int i = 2; !taken_.insert(name).second; ++i) name = stem + " " + std::to_string(i);
    return name;
  }

 private:
  std::set<std::string> taken_;
};

Shape shape_of(const DemoWorld& world, ShapeId shape, Vec2d centre) {
  const ShapeDefinition definition = world.definition(shape);
  return {.geometry = std::visit([](const auto& each) { return Geometry{each}; }, definition.geometry),
          .position = definition.position - centre,
          .angle = definition.angle,
          .friction = definition.material.friction,
          .restitution = definition.material.restitution,
          .filter = definition.filter,
          .rolling_resistance = definition.material.rolling_resistance,
          .surface_speed = definition.material.surface_speed};
}

Body body_of(const DemoWorld& world, BodyId body, std::string name) {
  const BodyState state = world.state(body);
  const BodyLocks locks = world.locks(body);
  Body out{.name = std::move(name),
           .type = world.type(body),
           .position = state.position,
           .angle = state.angle,
           .velocity = state.velocity,
           .angular_velocity = state.angular_velocity,
           .fixed_rotation = locks.rotation,
           .gravity_scale = world.gravity_scale(body),
           .linear_damping = world.linear_damping(body),
           .angular_damping = world.angular_damping(body),
           .lock_x = locks.x,
           .lock_y = locks.y};
  if (out.type == BodyType::Dynamic) {
    out.mass = world.mass(body);
    if (!locks.rotation) out.inertia = world.inertia(body);
  }
  const Vec2d centre = local_centre(world, body);
  for (const ShapeId shape : world.shapes(body))
    if (!world.sensor(shape)) out.shapes.push_back(shape_of(world, shape, centre));
  return out;
}

// One end of a joint: the body's name, and the anchor in the frame that scenes use.
struct End {
  std::string name;
  Vec2d origin{};  // m, origin of that frame in the frame of the world's body
};

class JointOf {
 public:
  JointOf(const DemoWorld& world, JointId joint, std::string name, End a, End b)
      : common_(world.definition(joint)), name_(std::move(name)), a_(std::move(a)), b_(std::move(b)) {}

  std::optional<Joint> operator()(const DistanceDefinition& d) const {
    auto joint = made<DistanceJoint>(d);
    joint.length = d.length, joint.spring = d.spring, joint.range = d.range, joint.motor = d.motor;
    return joint;
  }
  std::optional<Joint> operator()(const RevoluteDefinition& d) const {
    auto joint = made<RevoluteJoint>(d);
    joint.reference_angle = d.reference_angle, joint.target_angle = d.target_angle;
    joint.limits = d.limits, joint.motor = d.motor, joint.spring = d.spring;
    return joint;
  }
  std::optional<Joint> operator()(const PrismaticDefinition& d) const {
    auto joint = made<PrismaticJoint>(d);
    joint.axis = d.axis, joint.reference_angle = d.reference_angle;
    joint.target_translation = d.target_translation;
    joint.limits = d.limits, joint.motor = d.motor, joint.spring = d.spring;
    return joint;
  }
  std::optional<Joint> operator()(const WeldDefinition& d) const {
    auto joint = made<WeldJoint>(d);
    joint.reference_angle = d.reference_angle;
    joint.linear_spring = d.linear_spring, joint.angular_spring = d.angular_spring;
    return joint;
  }
  std::optional<Joint> operator()(const WheelDefinition& d) const {
    auto joint = made<WheelJoint>(d);
    joint.axis = d.axis, joint.spring = d.spring, joint.limits = d.limits, joint.motor = d.motor;
    return joint;
  }
  std::optional<Joint> operator()(const GearDefinition& d) const {
    auto joint = made<GearJoint>(d);
    joint.ratio = d.ratio, joint.phase = d.phase;
    return joint;
  }
  std::optional<Joint> operator()(const PulleyDefinition& d) const {
    auto joint = made<PulleyJoint>(d);
    joint.ground_a = d.ground_a, joint.ground_b = d.ground_b;
    joint.ratio = d.ratio, joint.length = d.length;
    return joint;
  }
  std::optional<Joint> operator()(const RatchetDefinition& d) const {
    auto joint = made<RatchetJoint>(d);
    joint.tooth = d.tooth, joint.phase = d.phase;
    return joint;
  }
  std::optional<Joint> operator()(const FrictionDefinition& d) const {
    auto joint = made<FrictionJoint>(d);
    joint.max_force = d.max_force, joint.max_torque = d.max_torque;
    return joint;
  }
  std::optional<Joint> operator()(const MotorDefinition&) const { return {}; }
  std::optional<Joint> operator()(const MouseDefinition&) const { return {}; }

 private:
  template <class J, class Definition>
  J made(const Definition& definition) const {
    J joint;
    joint.name = name_, joint.body_a = a_.name, joint.body_b = b_.name;
    joint.collide = common_.collide;
    joint.break_force = common_.break_force, joint.break_torque = common_.break_torque;
    if constexpr (requires { joint.anchor_a; }) joint.anchor_a = definition.anchor_a - a_.origin;
    if constexpr (requires { joint.anchor_b; }) joint.anchor_b = definition.anchor_b - b_.origin;
    return joint;
  }

  JointDefinition common_;
  std::string name_;
  End a_, b_;
};

}  // namespace

Scene scene_of(const DemoWorld& world, const std::string& name) {
  Scene scene{.name = name, .gravity = world.gravity()};
  Names bodies, joints;
  std::map<std::uint32_t, End> ends;  // by the body's index
  for (const BodyId body : world.bodies()) {
    if (world.type(body) == BodyType::Static && world.shapes(body).empty()) {
      ends[body.index] = {std::string(kWorld), -world.position(body)};
      continue;
    }
    scene.bodies.push_back(body_of(world, body, bodies.unique(world.name(body), "body")));
    ends[body.index] = {scene.bodies.back().name, local_centre(world, body)};
  }
  std::set<std::uint32_t> seen;
  for (const BodyId body : world.bodies()) {
    for (const JointId joint : world.joints(body)) {
      if (!seen.insert(joint.index).second) continue;
      const auto [a, b] = world.bodies(joint);
      const JointOf of(world, joint, joints.unique("", "joint"), ends.at(a.index), ends.at(b.index));
      if (const std::optional<Joint> made = std::visit(of, world.kind(joint))) scene.joints.push_back(*made);
    }
  }
  return scene;
}

}  // namespace plumb::demos
