#include "bench/field/scenes/ragdoll.h"

#include <numbers>

namespace plumb::field {
namespace {

constexpr double kPi = std::numbers::pi;

/// One bone: an upright capsule, and the joint to its parent. Lengths in m above the soles, angles in rad.
struct Bone {
  int parent;                 ///< index of a bone before this one; -1 for the hip
  double height;              ///< height of the body's frame
  double low, high, radius;   ///< ends of the capsule's axis relative to the frame; radius
  double pivot;               ///< height of the joint
  double lower, upper;        ///< limits of the joint
  double friction;            ///< factor of the joint's friction torque
  double rest = 0;            ///< angle at which the joint's angle is 0
  double linear_damping = 0;  ///< 1/s
  bool foot = false;
};

constexpr std::array<Bone, kBones> kSkeleton{{
    {-1, 0.95, -0.02, 0.02, 0.095, 0, 0, 0, 1},                                         // hip
    {0, 1.2, -0.135, 0.135, 0.09, 1.0, -0.25 * kPi, 0, 0.5},                            // torso
    {1, 1.475, -0.038, 0.039, 0.075, 1.4, -0.3 * kPi, 0.1 * kPi, 0.25, 0, 0.1},         // head
    {0, 0.775, -0.125, 0.125, 0.06, 0.9, -0.05 * kPi, 0.4 * kPi, 1},                    // left thigh
    {3, 0.475, -0.155, 0.125, 0.045, 0.625, -0.5 * kPi, -0.02 * kPi, 0.5, 0, 0, true},  // left shin
    {0, 0.775, -0.125, 0.125, 0.06, 0.9, -0.05 * kPi, 0.4 * kPi, 1},                    // right thigh
    {5, 0.475, -0.155, 0.125, 0.045, 0.625, -0.5 * kPi, -0.02 * kPi, 0.5, 0, 0, true},  // right shin
    {1, 1.225, -0.125, 0.125, 0.035, 1.35, -0.1 * kPi, 0.8 * kPi, 0.5},                 // left upper arm
    {7, 0.975, -0.125, 0.125, 0.03, 1.1, -0.2 * kPi, 0.3 * kPi, 0.1, 0.25 * kPi, 0.1},  // left forearm
    {1, 1.225, -0.125, 0.125, 0.035, 1.35, -0.1 * kPi, 0.8 * kPi, 0.5},                 // right upper arm
    {9, 0.975, -0.125, 0.125, 0.03, 1.1, -0.2 * kPi, 0.3 * kPi, 0.1, 0.25 * kPi, 0.1},  // right forearm
}};

std::vector<ShapeDefinition> shapes_of(const Bone& bone, int group) {
  const ShapeDefinition limb{.geometry = Capsule{{0, bone.low}, {0, bone.high}, bone.radius},
                             .friction = 0.2,
                             .group = group,
                             .category = 2,
                             .mask = 1 | 2};
  if (!bone.foot) return {limb};
  ShapeDefinition foot = limb;
  foot.geometry = Polygon{{{-0.03, -0.185}, {0.11, -0.185}, {0.11, -0.16}, {-0.03, -0.14}}, 0.015};
  foot.friction = 0.05;
  foot.mask = 1;
  return {limb, foot};
}

}  // namespace

std::array<int, kBones> add_ragdoll(Builder& world, Vec2d position, int group) {
  std::array<int, kBones> bodies{};
  for (int i = 0; i < kBones; ++i) {
    const Bone& bone = kSkeleton[i];
    bodies[i] = world.create_body(
        {.position = position + Vec2d{0, bone.height}, .linear_damping = bone.linear_damping},
        shapes_of(bone, group));
    if (bone.parent < 0) continue;
    world.create_revolute(bodies[bone.parent], bodies[i],
                          {.anchor_a = {0, bone.pivot - kSkeleton[bone.parent].height},
                           .anchor_b = {0, bone.pivot - bone.height},
                           .reference_angle = bone.rest,
                           .limits = Limits{bone.lower, bone.upper},
                           .motor = Motor{.speed = 0, .max_torque = 0.05 * bone.friction},
                           .spring = AngularSpring{.hertz = 5, .damping_ratio = 0.5}});
  }
  return bodies;
}

}  // namespace plumb::field
