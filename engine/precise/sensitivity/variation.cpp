#include "engine/precise/sensitivity/variation.h"

#include <algorithm>
#include <cmath>

#include "engine/precise/dynamics/scene_partition.h"
#include "engine/scene/number.h"

namespace plumb::precise {
namespace {

double scale_of(NumberKind kind, double value, double length) {
  switch (kind) {
    case NumberKind::Length:
      return length;
    case NumberKind::Angle:
      return 1;
    case NumberKind::Relative:
      break;
  }
  return value != 0 ? std::abs(value) : 1;
}

// Joints take a rope's length, or an angle at creation, from the start of their bodies, so their laws depend
// on the start.
bool is_joined(const Scene& scene, const std::string& body) {
  return std::any_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) {
    return std::visit([&](const auto& j) { return j.body_a == body || j.body_b == body; }, joint);
  });
}

}  // namespace

std::vector<Variation> variations_of(const Scene& scene, const std::vector<std::string>& names,
                                     const std::function<Scene(const Scene&)>& prepared) {
  std::vector<Variation> variations;
  if (names.empty()) return variations;
  const Scene base = prepared(scene);
  const ScenePartition partition = partition_scene(base);
  const double length = scales_of(base, partition).length;
  for (const std::string& name : names) {
    Variation& variation = variations.emplace_back();
    variation.name = name;
    Scene copy = scene;
    variation.step =
        Variation::kStep * scale_of(kind_of_number(copy, name), *numbers_at(copy, name)[0], length);
    const auto body = body_of_initial_state(scene, name);
    variation.initial_only =
        body && !is_joined(scene, scene.bodies[*body].name) &&
        std::binary_search(partition.integrated.begin(), partition.integrated.end(), *body);
    for (std::size_t i = 0; i < Variation::kOffsets.size(); ++i) {
      Scene perturbed = scene;
      for (double* number : numbers_at(perturbed, name)) *number += Variation::kOffsets[i] * variation.step;
      variation.scenes[i] = prepared(perturbed);
    }
  }
  return variations;
}

}  // namespace plumb::precise
