#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "engine/scene/features.h"
#include "engine/scene/text.h"
#include "engine/simulation/precise.h"
#include "engine/simulation/precise_parts.h"

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
  constexpr const char* kElsewhere = ", which Precise does not have; 'plumb-world' runs it";
  Scene bodies = scene;
  bodies.joints.clear();
  if (const std::string feature = unusual_field(bodies); !feature.empty()) return feature + kElsewhere;
  for (const Joint& joint : scene.joints) {
    const std::string missing = missing_in(joint);
    if (missing.empty()) continue;
    return "joint " + quoted(std::visit([](const auto& j) { return j.name; }, joint)) + " " + missing +
           kElsewhere;
  }
  // Every evaluation involves all contacts at once: its cost grows at least with the square of their number.
  constexpr std::size_t kMostBodies = 300;
  const precise::Parts parts = precise::divide(scene);
  std::vector<char> touches(scene.bodies.size(), 0);
  for (const precise::Outline& outline : parts.outlines) {
    if (scene.bodies[outline.body].type == BodyType::Dynamic) touches[outline.body] = 1;
  }
  const auto count = static_cast<std::size_t>(std::count(touches.begin(), touches.end(), 1));
  if (count <= kMostBodies) return {};
  return std::to_string(count) + " dynamic bodies have shapes that may touch, and Precise is meant for " +
         std::to_string(kMostBodies) +
         " at most; use Realtime{.dt = 1.0 / 60, .substeps = 8, .iterations = 8}, or filter pairs out";
}

}  // namespace plumb
