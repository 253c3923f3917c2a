#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/core/text.h"
#include "engine/scene/features.h"
#include "engine/scene/names.h"
#include "reference/support/protocol.h"

// Compares what a scene needs with what an engine declares.
namespace plumb::reference::protocol {
namespace {

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string missing_of_body(const Body& body, const Hello& hello) {
  const std::string who = "body " + plumb::quoted(body.name) + " ";
  if (body.type == BodyType::Kinematic && !contains(hello.features, "kinematic")) return who + "is kinematic";
  if (body.fixed_rotation && !contains(hello.features, "fixed_rotation")) return who + "has a fixed rotation";
  for (const Shape& shape : body.shapes) {
    const std::string kind(kGeometryNames[shape.geometry.index()]);
    if (!contains(hello.shapes, kind)) return who + "has a " + kind;
  }
  return "";
}

bool jointed_apart(const Scene& scene, const std::string& a, const std::string& b) {
  return std::any_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) {
    return std::visit(
        [&](const auto& j) {
          return !j.collide && ((j.body_a == a && j.body_b == b) || (j.body_a == b && j.body_b == a));
        },
        joint);
  });
}

bool some_may_touch(const std::vector<Shape>& a, const std::vector<Shape>& b) {
  for (const Shape& one : a) {
    for (const Shape& other : b) {
      if (may_touch(one.filter, other.filter)) return true;
    }
  }
  return false;
}

/// Returns the names of two bodies that may touch, or nullopt if no contact is possible.
std::optional<std::pair<std::string, std::string>> pair_that_may_touch(const Scene& scene) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < scene.bodies.size(); ++j) {
      const Body &a = scene.bodies[i], &b = scene.bodies[j];
      if (a.type != BodyType::Dynamic && b.type != BodyType::Dynamic) continue;
      if (some_may_touch(a.shapes, b.shapes) && !jointed_apart(scene, a.name, b.name)) {
        return std::pair(a.name, b.name);
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::string missing_capability(const Scene& scene, const Hello& hello) {
  const std::string lacks = ", which it does not declare";
  if (const std::string rule = unusual_rule(scene); !rule.empty())
    return rule + ", which the protocol's engines do not have; 'plumb-precise' runs it";
  if (const std::string field = unusual_field(scene); !field.empty())
    return field + ", which the protocol's engines do not have; 'plumb' runs it";
  for (const Body& body : scene.bodies) {
    const std::string missing = missing_of_body(body, hello);
    if (!missing.empty()) return missing + lacks;
  }
  for (const Joint& joint : scene.joints) {
    const std::string kind(kJointNames[joint.index()]);
    const auto& name = std::visit([](const auto& j) -> const std::string& { return j.name; }, joint);
    if (!contains(hello.joints, kind))
      return "joint " + plumb::quoted(name) + " is a " + kind + " joint" + lacks;
  }
  for (const ForceLaw& law : scene.forces) {
    const std::string kind(kForceNames[law.index()]);
    if (!contains(hello.forces, kind)) return "the scene has a " + kind + lacks;
  }
  if (!contains(hello.features, "contacts")) {
    if (const auto pair = pair_that_may_touch(scene)) {
      return "bodies " + plumb::quoted(pair->first) + " and " + plumb::quoted(pair->second) +
             " may touch, and it has no contacts";
    }
    return "";
  }
  if (contains(hello.features, "filters")) return "";
  for (const Body& body : scene.bodies) {
    for (const Shape& shape : body.shapes) {
      if (shape.filter != Filter{})
        return "body " + plumb::quoted(body.name) + " has a collision filter" + lacks;
    }
  }
  return "";
}

}  // namespace plumb::reference::protocol
