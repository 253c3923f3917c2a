#include "engine/world/add_scene.h"

#include <map>
#include <string_view>

#include "engine/scene/error.h"
#include "engine/scene/subject.h"
#include "engine/scene/validate.h"

namespace plumb {
namespace {

void refuse_what_a_world_lacks(const Scene& scene) {
  const std::string subject = scene_subject(scene.name);
  if (!scene.forces.empty()) {
    throw Error(Error::Kind::Unsupported, subject, "forces", std::to_string(scene.forces.size()),
                "are not part of a world; apply them before each step");
  }
  if (scene.contact_rules.restitution_threshold > 0) {
    throw Error(Error::Kind::Unsupported, subject, "restitution_threshold",
                std::to_string(scene.contact_rules.restitution_threshold),
                "is the world's own: it follows from gravity and the step");
  }
}

BodyDefinition definition_of(const Body& body) {
  BodyDefinition definition;
  definition.name = body.name;
  definition.type = body.type;
  definition.position = body.position;
  definition.angle = body.angle;
  definition.velocity = body.velocity;
  definition.angular_velocity = body.angular_velocity;
  definition.lock_rotation = body.fixed_rotation;
  if (body.type != BodyType::Dynamic) return definition;
  const double inertia = inertia_of(body);
  definition.mass = MassProperties{body.mass, {}, inertia > 0 ? inertia : 1};
  definition.lock_rotation = body.fixed_rotation || !(inertia > 0);
  return definition;
}

ShapeDefinition definition_of(const Shape& shape) {
  ShapeDefinition definition;
  std::visit([&](const auto& geometry) { definition.geometry = geometry; }, shape.geometry);
  definition.position = shape.position;
  definition.angle = shape.angle;
  definition.material = {.friction = shape.friction, .restitution = shape.restitution};
  definition.filter = shape.filter;
  return definition;
}

struct KindOf {
  JointKind operator()(const RevoluteJoint& joint) const {
    return RevoluteDefinition{.anchor_a = joint.anchor_a, .anchor_b = joint.anchor_b};
  }
  JointKind operator()(const DistanceJoint& joint) const {
    return DistanceDefinition{.anchor_a = joint.anchor_a, .anchor_b = joint.anchor_b, .length = joint.length};
  }
};

}  // namespace

WorldDefinition world_definition(const Scene& scene) {
  return {.gravity = scene.gravity,
          .combine_friction = scene.contact_rules.friction,
          .combine_restitution = scene.contact_rules.restitution};
}

template <class Real>
SceneParts add_scene(BasicWorld<Real>& world, const Scene& scene) {
  validate(scene);
  refuse_what_a_world_lacks(scene);
  SceneParts parts;
  std::map<std::string_view, BodyId> by_name;
  for (const Body& body : scene.bodies) {
    std::vector<ShapeDefinition> shapes;
    for (const Shape& shape : body.shapes) shapes.push_back(definition_of(shape));
    parts.bodies.push_back(world.create_body(definition_of(body), shapes));
    by_name[body.name] = parts.bodies.back();
  }
  const auto find = [&](const std::string& name) {
    if (name != kWorld) return by_name.at(name);
    if (!world.valid(parts.frame)) {
      BodyDefinition frame;
      frame.type = BodyType::Static;
      parts.frame = world.create_body(frame);
    }
    return parts.frame;
  };
  for (const Joint& joint : scene.joints) {
    const auto [body_a, body_b, collide] =
        std::visit([](const auto& j) { return std::tuple(j.body_a, j.body_b, j.collide); }, joint);
    JointDefinition definition;
    definition.kind = std::visit(KindOf{}, joint);
    definition.collide = collide;
    parts.joints.push_back(world.create_joint(find(body_a), find(body_b), definition));
  }
  return parts;
}

template SceneParts add_scene(BasicWorld<float>&, const Scene&);
template SceneParts add_scene(BasicWorld<double>&, const Scene&);

}  // namespace plumb
