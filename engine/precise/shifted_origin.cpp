#include "engine/precise/shifted_origin.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/precise/dynamics/scene_partition.h"

namespace plumb::precise {

Vec2d local_origin(const Scene& scene) {
  // Formulas are in the scene's own coordinates.
  for (const ForceLaw& law : scene.forces)
    if (std::holds_alternative<FormulaForce>(law)) return {};
  for (const Body& body : scene.bodies)
    if (!body.motion.empty()) return {};
  /// Distance from the origin, in extents, beyond which a scene is shifted: there, coordinates have lost six
  /// bits.
  constexpr double kFar = 64;
  Vec2d lower{1e300, 1e300}, upper{-1e300, -1e300};
  for (const Body& body : scene.bodies) {
    if (body.type != BodyType::Dynamic) continue;
    lower = {std::min(lower.x, body.position.x), std::min(lower.y, body.position.y)};
    upper = {std::max(upper.x, body.position.x), std::max(upper.y, body.position.y)};
  }
  if (!(lower.x <= upper.x)) return {};
  const Vec2d centre = 0.5 * (lower + upper), size = upper - lower;
  const double extent = std::max({size.x, size.y, scales_of(scene, partition_scene(scene)).length});
  if (std::max(std::abs(centre.x), std::abs(centre.y)) < kFar * extent) return {};
  // Rounded to float, so that differences to it are exact.
  const Vec2d origin{static_cast<float>(centre.x), static_cast<float>(centre.y)};
  return std::isfinite(origin.x) && std::isfinite(origin.y) ? origin : Vec2d{};
}

Scene relative_to(const Scene& scene, Vec2d origin) {
  Scene shifted = scene;
  for (Body& body : shifted.bodies) body.position -= origin;
  for (Joint& joint : shifted.joints) {
    std::visit(
        [&](auto& j) {
          if constexpr (requires { j.ground_a; }) j.ground_a -= origin, j.ground_b -= origin;
          if constexpr (requires { j.target; }) j.target -= origin;
          if constexpr (requires { j.anchor_a; }) {
            if (j.body_a == kWorld) j.anchor_a -= origin;
          }
          if constexpr (requires { j.anchor_b; }) {
            if (j.body_b == kWorld) j.anchor_b -= origin;
          }
          if constexpr (requires { j.target_position; }) {
            if (j.body_a == kWorld) j.target_position -= origin;
          }
        },
        joint);
  }
  for (ForceLaw& law : shifted.forces) {
    std::visit(
        [&](auto& l) {
          if constexpr (requires { l.anchor_a; }) {
            if (l.body_a == kWorld) l.anchor_a -= origin;
            if (l.body_b == kWorld) l.anchor_b -= origin;
          }
          if constexpr (requires { l.centre_body; }) {
            if (l.centre_body == kWorld) l.centre -= origin;
          }
        },
        law);
  }
  return shifted;
}

}  // namespace plumb::precise
