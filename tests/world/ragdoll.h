#pragma once

#include <vector>

#include "engine/math/trigonometry.h"
#include "engine/world/world.h"

namespace plumb {

/// Start of a ragdoll as a whole: turned and spinning about its torso's centre.
struct RagdollStart {
  Vec2d at{};               ///< m
  double tilt = 0;          ///< rad
  Vec2d velocity{};         ///< m/s
  double spin = 0;          ///< rad/s
  int group = -1;           ///< whose parts pass through each other
  double head_density = 2;  ///< kg/m^2; that of all else is 2
};

/// A torso, a head, two arms and two legs, with limits; the torso is the first.
inline std::vector<BodyId> add_ragdoll(World& world, const RagdollStart& start) {
  const Rotation<double> q = rotation_of(start.tilt);
  const auto part = [&](Vec2d centre, double width, double height, double density = 2) {
    BodyDefinition body;
    body.position = start.at + q * centre;
    body.angle = start.tilt;
    body.velocity = start.velocity + cross(start.spin, q * centre);
    body.angular_velocity = start.spin;
    return world.create_body(
        body, ShapeDefinition{
                  .geometry = Box{width, height}, .density = density, .filter = {.group = start.group}});
  };
  const BodyId torso = part({0, 0}, 0.4, 0.8), head = part({0, 0.6}, 0.3, 0.3, start.head_density);
  std::vector<BodyId> parts{torso, head};
  const auto hang = [&](Vec2d joint, Vec2d centre, double width, double height, double lower, double upper) {
    const BodyId limb = part(centre, width, height);
    world.create_joint(torso, limb,
                       {.kind = RevoluteDefinition{
                            .anchor_a = joint, .anchor_b = joint - centre, .limits = Range{lower, upper}}});
    parts.push_back(limb);
  };
  world.create_joint(
      torso, head,
      {.kind = RevoluteDefinition{.anchor_a = {0, 0.4}, .anchor_b = {0, -0.2}, .limits = Range{-0.5, 0.5}}});
  hang({-0.2, 0.35}, {-0.5, 0.35}, 0.6, 0.15, -1.5, 1.5);
  hang({0.2, 0.35}, {0.5, 0.35}, 0.6, 0.15, -1.5, 1.5);
  hang({-0.12, -0.4}, {-0.12, -0.8}, 0.18, 0.8, -1, 0.6);
  hang({0.12, -0.4}, {0.12, -0.8}, 0.18, 0.8, -0.6, 1);
  return parts;
}

}  // namespace plumb
