#include "engine/scene/features.h"

#include <string_view>
#include <type_traits>
#include <utility>

#include "engine/core/text.h"
#include "engine/scene/joint_fields.h"
#include "engine/scene/names.h"

namespace plumb {
namespace {

constexpr std::size_t kUsualGeometries = 2;  // circle, box
constexpr std::size_t kUsualJoints = 2;      // revolute, distance

std::string body_called(const Body& body) { return "body " + quoted(body.name) + " has "; }

std::string unusual_field_of(const Body& body) {
  if (body.gravity_scale != 1) return "gravity_scale";
  if (body.linear_damping != 0) return "linear_damping";
  if (body.angular_damping != 0) return "angular_damping";
  if (body.lock_x) return "lock_x";
  if (body.lock_y) return "lock_y";
  if (!body.motion.empty()) return "a prescribed motion";
  for (const Shape& shape : body.shapes) {
    if (shape.rolling_resistance != 0) return "a shape with rolling_resistance";
    if (shape.surface_speed != 0) return "a shape with surface_speed";
  }
  return "";
}

/// Returns the first field with a value other than its default, apart from anchors, `length` and `collide`.
template <class J>
std::string unusual_field_of(const J& joint) {
  static const J kDefault{};
  std::string found;
  const auto visit_field = [&](std::string_view key, const auto& value, const FieldRule&) {
    if (!found.empty() || key == "collide" || key == "length") return;
    const auto compare_default = [&](std::string_view name, const auto& usual, const FieldRule&) {
      if constexpr (std::is_same_v<decltype(usual), decltype(value)>) {
        if (name == key && !(usual == value)) found = key;
      }
    };
    own_fields(kDefault, compare_default);
    last_fields(kDefault, compare_default);
  };
  own_fields(joint, visit_field);
  last_fields(joint, visit_field);
  return found;
}

}  // namespace

std::string unusual_kind(const Scene& scene) {
  for (const Body& body : scene.bodies) {
    for (const Shape& shape : body.shapes) {
      const std::size_t kind = shape.geometry.index();
      if (kind >= kUsualGeometries) return body_called(body) + "a " + std::string(kGeometryNames[kind]);
    }
  }
  for (const Joint& joint : scene.joints) {
    if (joint.index() < kUsualJoints) continue;
    const auto name = std::visit([](const auto& j) { return j.name; }, joint);
    return "joint " + quoted(name) + " is a " + std::string(kJointNames[joint.index()]) + " joint";
  }
  return "";
}

std::string unusual_rule(const Scene& scene) {
  const ContactRules& rules = scene.contact_rules;
  const std::string has = "contact_rules has ";
  if (rules.impact != ImpactRule::Newton)
    return has + "impact " + quoted(kImpactNames[static_cast<std::size_t>(rules.impact)]);
  if (rules.yield_speed != 0) return has + "yield_speed";
  if (rules.tangential_restitution != 0) return has + "tangential_restitution";
  if (rules.friction_after_stop != 1) return has + "friction_after_stop";
  if (rules.friction_while_sliding != 1) return has + "friction_while_sliding";
  return "";
}

std::string unusual_field(const Scene& scene) {
  for (const Body& body : scene.bodies) {
    if (const std::string field = unusual_field_of(body); !field.empty()) return body_called(body) + field;
  }
  for (const Joint& joint : scene.joints) {
    if (joint.index() >= kUsualJoints) continue;
    const auto [name, field] =
        std::visit([](const auto& j) { return std::pair(j.name, unusual_field_of(j)); }, joint);
    if (!field.empty()) return "joint " + quoted(name) + " has " + field;
  }
  if (!scene.drives.empty()) return "joint " + quoted(scene.drives.front().joint) + " has a drive";
  return "";
}

std::string unusual_feature(const Scene& scene) {
  std::string found = unusual_kind(scene);
  return found.empty() ? unusual_field(scene) : found;
}

}  // namespace plumb
