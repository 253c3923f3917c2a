#include "engine/world/add_scene.h"

#include <map>
#include <string_view>
#include <tuple>

#include "engine/core/text.h"
#include "engine/joints/joint_check.h"
#include "engine/joints/kind_of.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "engine/scene/features.h"
#include "engine/scene/subject.h"
#include "engine/scene/validate.h"
#include "engine/world/state/naming.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

BodyDefinition definition_of(const Body& body) {
  BodyDefinition definition;
  definition.name = body.name;
  definition.type = body.type;
  const BodyState start = initial_state(body);
  definition.position = start.position;
  definition.angle = start.angle;
  definition.velocity = start.velocity;
  definition.angular_velocity = start.angular_velocity;
  definition.lock_rotation = body.fixed_rotation;
  definition.gravity_scale = body.gravity_scale;
  definition.linear_damping = body.linear_damping;
  definition.angular_damping = body.angular_damping;
  definition.lock_x = body.lock_x;
  definition.lock_y = body.lock_y;
  if (body.type != BodyType::Dynamic) return definition;
  const double inertia = inertia_of(body);
  definition.mass = MassProperties{body.mass, {}, inertia > 0 ? inertia : 1};
  definition.lock_rotation = body.fixed_rotation || !(inertia > 0);
  return definition;
}

Material material_of(const Shape& shape) {
  return {.friction = shape.friction,
          .restitution = shape.restitution,
          .rolling_resistance = shape.rolling_resistance,
          .surface_speed = shape.surface_speed};
}

/// Definitions of a body's shapes. Chains are created one by one after the body.
struct Shapes {
  std::vector<ShapeDefinition> solid;
  std::vector<ChainDefinition> chains;
};

struct AddShape {
  Shapes& to;
  const Shape& shape;

  void operator()(const Chain& chain) const {
    ChainDefinition definition{
        .closed = chain.closed, .material = material_of(shape), .filter = shape.filter};
    const Rotation<double> rotation = rotation_of(shape.angle);
    for (const Vec2d point : chain.points) definition.points.push_back(shape.position + rotation * point);
    to.chains.push_back(std::move(definition));
  }

  void operator()(const auto& geometry) const {
    ShapeDefinition definition;
    definition.geometry = geometry;
    definition.position = shape.position;
    definition.angle = shape.angle;
    definition.density = shape.density.value_or(definition.density);
    definition.material = material_of(shape);
    definition.filter = shape.filter;
    to.solid.push_back(std::move(definition));
  }
};

Shapes shapes_of(const Body& body) {
  Shapes out;
  for (const Shape& shape : body.shapes) std::visit(AddShape{out, shape}, shape.geometry);
  return out;
}

JointDefinition definition_of(const Joint& joint) {
  return std::visit(
      [&](const auto& j) {
        return JointDefinition{.kind = kind_of(joint),
                               .collide = j.collide,
                               .break_force = j.break_force,
                               .break_torque = j.break_torque};
      },
      joint);
}

}  // namespace

WorldDefinition world_definition(const Scene& scene) {
  WorldDefinition definition;
  definition.gravity = scene.gravity;
  definition.combine_friction = scene.contact_rules.friction;
  definition.combine_restitution = scene.contact_rules.restitution;
  return definition;
}

std::string world_unsupported(const Scene& scene) {
  if (const std::string rule = unusual_rule(scene); !rule.empty())
    return rule + ", which only Precise has; 'plumb-precise' runs it";
  if (scene.contact_rules.restitution_threshold > 0)
    return "restitution_threshold is " + shortest(scene.contact_rules.restitution_threshold) +
           ": a World's own follows from gravity and the step";
  return "";
}

template <class Real>
void require_in_range(const Scene& scene) {
  validate(world_definition(scene));
  for (const Body& body : scene.bodies) {
    validate(definition_of(body));
    const Shapes shapes = shapes_of(body);
    const std::string of = " of body " + quoted(body.name);
    const bool mass_from_shapes = body.type == BodyType::Dynamic && !definition_of(body).mass;
    with_subject([&] { return "shape" + of; },
                 [&] {
                   for (const ShapeDefinition& shape : shapes.solid) {
                     validate(shape);
                     if (std::is_same_v<Real, float> && mass_from_shapes) require_float_mass(shape);
                   }
                 });
    with_subject([&] { return "chain" + of; },
                 [&] {
                   for (const ChainDefinition& chain : shapes.chains) validate(chain);
                 });
  }
  for (const Joint& joint : scene.joints) validate(definition_of(joint));
}

template <class Real>
SceneParts add_scene(BasicWorld<Real>& world, const Scene& scene) {
  validate(scene);
  if (const std::string reason = world_unsupported(scene); !reason.empty())
    throw Error(Error::Kind::Unsupported, scene_subject(scene.name), "", "", reason);
  require_in_range<Real>(scene);
  SceneParts parts;
  std::map<std::string_view, BodyId> by_name;
  for (const Body& body : scene.bodies) {
    const Shapes shapes = shapes_of(body);
    parts.bodies.push_back(world.create_body(definition_of(body), shapes.solid));
    for (const ChainDefinition& chain : shapes.chains) world.create_chain(parts.bodies.back(), chain);
    by_name[body.name] = parts.bodies.back();
  }
  const auto find_or_add_frame = [&](const std::string& name) {
    if (name != kWorld) return by_name.at(name);
    if (!world.valid(parts.frame)) {
      BodyDefinition frame;
      frame.type = BodyType::Static;
      parts.frame = world.create_body(frame);
    }
    return parts.frame;
  };
  for (const Joint& joint : scene.joints) {
    const auto [name_a, name_b] =
        std::visit([](const auto& j) { return std::tuple(j.body_a, j.body_b); }, joint);
    const BodyId a = find_or_add_frame(name_a), b = find_or_add_frame(name_b);
    parts.joints.push_back(world.create_joint(a, b, definition_of(joint)));
  }
  return parts;
}

template void require_in_range<float>(const Scene&);
template void require_in_range<double>(const Scene&);
template SceneParts add_scene(BasicWorld<float>&, const Scene&);
template SceneParts add_scene(BasicWorld<double>&, const Scene&);

}  // namespace plumb
