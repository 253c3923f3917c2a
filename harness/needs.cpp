#include "harness/needs.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <variant>

#include "engine/scene/names.h"

namespace plumb::harness {
namespace {

constexpr std::string_view kFeatures[] = {
    "contacts",       "friction",    "restitution", "filters",       "kinematic",
    "fixed_rotation", "locked_axes", "damping",     "gravity_scale", "rolling_resistance",
    "surface_speed",  "limits",      "motors",      "springs"};

std::string joint_need(std::size_t kind) { return std::string(kJointNames[kind]) + " joint"; }
std::string force_need(std::size_t kind) {
  const std::string name(kForceNames[kind]);
  return name == "spring" ? name + " force" : name;  // joints have springs as well
}

bool held_apart(const Scene& scene, const Body& a, const Body& b) {
  return std::ranges::any_of(scene.joints, [&](const Joint& joint) {
    return std::visit(
        [&](const auto& j) {
          return !j.collide &&
                 ((j.body_a == a.name && j.body_b == b.name) || (j.body_a == b.name && j.body_b == a.name));
        },
        joint);
  });
}

void add_contacts(const Scene& scene, std::set<std::string>& needs) {
  const ContactRules& rules = scene.contact_rules;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Body &a = scene.bodies[i], &b = scene.bodies[k];
      if (a.type != BodyType::Dynamic && b.type != BodyType::Dynamic) continue;
      if (held_apart(scene, a, b)) continue;
      for (const Shape& one : a.shapes) {
        for (const Shape& other : b.shapes) {
          if (!may_touch(one.filter, other.filter)) {
            needs.insert("filters");
            continue;
          }
          needs.insert("contacts");
          for (const Shape* shape : {&one, &other}) {
            needs.insert(std::string(kGeometryNames[shape->geometry.index()]));
            if (shape->rolling_resistance != 0) needs.insert("rolling_resistance");
            if (shape->surface_speed != 0) needs.insert("surface_speed");
          }
          if (combine(rules.friction, one.friction, other.friction) > 0) needs.insert("friction");
          if (combine(rules.restitution, one.restitution, other.restitution) > 0) needs.insert("restitution");
        }
      }
    }
  }
  if (!needs.contains("contacts")) needs.erase("filters");
}

template <class J>
void add_joint(const J& joint, std::set<std::string>& needs) {
  if constexpr (requires { joint.limits; })
    if (joint.limits) needs.insert("limits");
  if constexpr (requires { joint.range; })
    if (joint.range) needs.insert("limits");
  if constexpr (requires { joint.motor; })
    if (joint.motor) needs.insert("motors");
  if constexpr (requires { joint.spring.has_value(); })
    if (joint.spring) needs.insert("springs");
  if constexpr (requires { joint.linear_spring; })
    if (joint.linear_spring || joint.angular_spring) needs.insert("springs");
}

}  // namespace

const std::vector<std::string>& all_needs() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names(kGeometryNames.begin(), kGeometryNames.end());
    for (std::size_t i = 0; i < kJointNames.size(); ++i) names.push_back(joint_need(i));
    for (std::size_t i = 0; i < kForceNames.size(); ++i) names.push_back(force_need(i));
    names.insert(names.end(), std::begin(kFeatures), std::end(kFeatures));
    return names;
  }();
  return all;
}

std::vector<std::string> needs_of(const Scene& scene) {
  std::set<std::string> needs;
  add_contacts(scene, needs);
  for (const Joint& joint : scene.joints) {
    needs.insert(joint_need(joint.index()));
    std::visit([&](const auto& j) { add_joint(j, needs); }, joint);
  }
  for (const ForceLaw& law : scene.forces) needs.insert(force_need(law.index()));
  for (const Body& body : scene.bodies) {
    if (body.type == BodyType::Kinematic) needs.insert("kinematic");
    if (body.type != BodyType::Dynamic) continue;
    if (body.fixed_rotation) needs.insert("fixed_rotation");
    if (body.lock_x || body.lock_y) needs.insert("locked_axes");
    if (body.linear_damping != 0 || body.angular_damping != 0) needs.insert("damping");
    if (body.gravity_scale != 1) needs.insert("gravity_scale");
  }
  std::vector<std::string> out;
  for (const std::string& name : all_needs())
    if (needs.contains(name)) out.push_back(name);
  return out;
}

}  // namespace plumb::harness
