#include <algorithm>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "engine/core/text.h"
#include "engine/precise/body_laws.h"
#include "engine/precise/dynamics/joints.h"
#include "engine/precise/dynamics/scene_partition.h"
#include "engine/precise/precise.h"
#include "engine/scene/features.h"
#include "engine/scene/formula.h"

namespace plumb {
namespace {

/// Returns the feature of a joint that Precise lacks, or nothing.
std::string missing_in(const Joint& joint) {
  std::string found;
  std::visit(
      [&](const auto& j) {
        if (j.break_force != 0) found = "break_force";
        if (j.break_torque != 0) found = "break_torque";
      },
      joint);
  if (!found.empty()) return "has " + found;
  if (std::holds_alternative<FrictionJoint>(joint)) return "is a friction joint";
  if (std::holds_alternative<RatchetJoint>(joint)) return "is a ratchet joint";
  return {};
}

}  // namespace

std::string precise_unsupported(const Scene& scene) {
  constexpr const char* kElsewhere = ", which Precise does not have; 'plumb' runs it";
  const ContactRules& rules = scene.contact_rules;
  if (rules.impact != ImpactRule::Newton && rules.simultaneous == Simultaneous::Together)
    return "contact_rules.simultaneous is \"together\": only Newton's law resolves impacts as one problem; "
           "use "
           "\"sequence\"";
  if (rules.impact == ImpactRule::Newton &&
      (rules.tangential_restitution != 0 || rules.friction_after_stop != 1))
    return "contact_rules has tangential_restitution or friction_after_stop, which belong to laws that "
           "follow the slip "
           "through an impact: use impact \"poisson\" or \"stronge\"";
  Scene bodies = precise::with_body_laws(scene);
  bodies.joints.clear();
  bodies.drives.clear();
  for (Body& body : bodies.bodies) body.motion = {};
  if (const std::string feature = unusual_field(bodies); !feature.empty()) return feature + kElsewhere;
  for (const Joint& joint : scene.joints) {
    const std::string missing = missing_in(joint);
    if (missing.empty()) continue;
    return "joint " + quoted(std::visit([](const auto& j) { return j.name; }, joint)) + " " + missing +
           kElsewhere;
  }
  // Every evaluation solves for all contacts at once, so its cost grows at least with the square of their
  // number.
  constexpr std::size_t kMaxBodies = 300;
  const precise::ScenePartition partition = precise::partition_scene(precise::with_body_laws(scene));
  std::vector<char> touches(scene.bodies.size(), 0);
  for (const precise::FeatureShape& shape : partition.shapes) {
    if (scene.bodies[shape.body].type == BodyType::Dynamic) touches[shape.body] = 1;
  }
  const auto count = static_cast<std::size_t>(std::count(touches.begin(), touches.end(), 1));
  if (count <= kMaxBodies) return {};
  return std::to_string(count) + " dynamic bodies have shapes that may touch, and Precise is meant for " +
         std::to_string(kMaxBodies) +
         " at most; use Realtime{.dt = 1.0 / 60, .substeps = 8}, or filter pairs out";
}

std::string symplectic_unsupported(const Scene& given) {
  const Scene scene = precise::with_body_laws(given);
  for (const ForceLaw& law : scene.forces) {
    const bool brakes = std::visit(
        [](const auto& l) {
          if constexpr (requires { l.tension; }) return Formula(l.tension, kSpringVariables).uses(2);
          if constexpr (std::is_same_v<std::remove_cvref_t<decltype(l)>, FormulaForce>) {
            for (const std::string* text : {&l.x, &l.y, &l.torque}) {
              const Formula formula(*text, kForceVariables);
              if (formula.uses(4) || formula.uses(5) || formula.uses(6)) return true;
            }
            return false;
          }
          if constexpr (requires { l.angular_coefficient; })
            return l.coefficient != 0 || l.angular_coefficient != 0;
          if constexpr (requires { l.coefficient; }) return l.coefficient != 0;
          if constexpr (requires { l.damping; }) return l.damping != 0;
          return false;
        },
        law);
    if (brakes) {
      return "a force depends on velocities: the symplectic method keeps energy only where none is lost; use "
             "method "
             "= automatic";
    }
  }
  for (const Body& body : scene.bodies) {
    if (!body.motion.empty())
      return "body " + quoted(body.name) +
             " has a prescribed motion, which does work: the symplectic method keeps energy only where none "
             "is "
             "added; use method = automatic";
  }
  if (precise::GeneralJoints(scene).has_springs()) {
    return "a joint has a spring, whose stiffness changes with its bodies' effective mass; use method = "
           "automatic";
  }
  if (!precise::partition_scene(scene).shapes.empty()) {
    return "shapes may touch, and impacts would cut the symplectic method's steps; use method = automatic";
  }
  return {};
}

}  // namespace plumb
