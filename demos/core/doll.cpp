#include "demos/core/doll.h"

#include <cmath>
#include <string>

namespace plumb::demos {
namespace {

// Positions of joints, m from the middle of the hip; the left side has x mirrored.
constexpr Vec2d kNeck{0, 0.61}, kHead{0, 0.78}, kChest{0, 0.3};
constexpr Vec2d kShoulder{0.2, 0.54}, kElbow{0.2, 0.26}, kHand{0.2, -0.02};
constexpr Vec2d kHip{0.1, 0.02}, kKnee{0.1, -0.4}, kFoot{0.1, -0.82};
constexpr Box kTorso{0.36, 0.6};
constexpr double kHeadRadius = 0.13, kArmRadius = 0.055, kThighRadius = 0.075, kShinRadius = 0.06;  // m

// Limits of the joints' angles relative to a standing figure, rad.
constexpr Range kNeckTurns{-0.5, 0.5}, kShoulderTurns{-0.9, 2.8}, kElbowTurns{-0.05, 2.4};
constexpr Range kHipTurns{-0.5, 1.9}, kKneeTurns{-2.4, 0.05};

// kg, of rigid parts; the masses of points, below, add up to the same 60 kg.
constexpr double kHeadMass = 5, kTorsoMass = 29, kUpperArmMass = 2, kForearmMass = 1.5, kThighMass = 6,
                 kShinMass = 3.5;
constexpr double kShoulderMass = 8, kHipMass = 10, kElbowMass = 1.75, kHandMass = 1, kKneeMass = 4.5,
                 kFootMass = 2.25;

struct Doll {
  DemoWorld& world;
  Vec2d hip;
  int group;

  BodyId part(const char* name, Vec2d middle, double mass, const ShapeGeometry& geometry, bool turns = true) {
    return world.create_body(
        {.name = name, .position = hip + middle, .angular_damping = 0.5, .lock_rotation = !turns},
        {.geometry = geometry,
         .density = mass / area_of(geometry),
         .material = {.friction = 0.5, .restitution = 0.1},
         .filter = {.group = -group}});
  }
  BodyId limb(const char* name, Vec2d from, Vec2d to, double radius, double mass) {
    const Vec2d half = 0.5 * (to - from);
    return part(name, from + half, mass, Capsule{-half, half, radius});
  }
  // Adds a point. Its rotation is fixed, because otherwise the figure would roll on its hands and feet.
  BodyId point(const char* name, Vec2d place, double mass, double radius) {
    return part(name, place, mass, Circle{radius}, false);
  }
  void hinge(BodyId a, BodyId b, Vec2d at, const Range& turns) {
    world.create_joint(a, b,
                       {.kind = RevoluteDefinition{.anchor_a = world.local_point(a, hip + at),
                                                   .anchor_b = world.local_point(b, hip + at),
                                                   .limits = turns}});
  }

 private:
  static double area_of(const ShapeGeometry& geometry) {
    return std::visit([](const auto& each) { return extent_of(Geometry{each}).area; }, geometry);
  }
};

Vec2d on_side(double side, Vec2d point) { return {side * point.x, point.y}; }

}  // namespace

void add_jointed_doll(DemoWorld& world, Vec2d hip, int group) {
  Doll doll{world, hip, group};
  const BodyId torso = doll.part("torso", kChest, kTorsoMass, kTorso);
  const BodyId head = doll.part("head", kHead, kHeadMass, Circle{kHeadRadius});
  doll.hinge(torso, head, kNeck, kNeckTurns);
  for (const double side : {-1.0, 1.0}) {
    const Vec2d shoulder = on_side(side, kShoulder), elbow = on_side(side, kElbow);
    const BodyId upper_arm = doll.limb("upper arm", shoulder, elbow, kArmRadius, kUpperArmMass);
    const BodyId forearm = doll.limb("forearm", elbow, on_side(side, kHand), kArmRadius, kForearmMass);
    doll.hinge(torso, upper_arm, shoulder, kShoulderTurns);
    doll.hinge(upper_arm, forearm, elbow, kElbowTurns);
    const Vec2d joint = on_side(side, kHip), knee = on_side(side, kKnee);
    const BodyId thigh = doll.limb("thigh", joint, knee, kThighRadius, kThighMass);
    const BodyId shin = doll.limb("shin", knee, on_side(side, kFoot), kShinRadius, kShinMass);
    doll.hinge(torso, thigh, joint, kHipTurns);
    doll.hinge(thigh, shin, knee, kKneeTurns);
  }
}

JointId add_stick(DemoWorld& world, BodyId a, BodyId b, double least) {
  const double length = std::sqrt(length_squared(world.centre(b) - world.centre(a)));
  DistanceDefinition stick{.length = length};
  if (least < 1) stick.range = Range{.lower = least * length};
  return world.create_joint(a, b, {.kind = stick});
}

void add_stick_doll(DemoWorld& world, Vec2d hip, int group) {
  Doll doll{world, hip, group};
  const BodyId head = doll.point("head", kHead, kHeadMass, kHeadRadius);
  BodyId shoulders[2], hips[2];
  for (const int i : {0, 1}) {
    const double side = 2 * i - 1;
    shoulders[i] = doll.point("shoulder", on_side(side, kShoulder), kShoulderMass, kArmRadius);
    hips[i] = doll.point("hip", on_side(side, kHip), kHipMass, kThighRadius);
  }
  // The torso is a frame with both diagonals. Sticks to the shoulders carry the head; sticks to the hips keep
  // it from sinking in.
  add_stick(world, shoulders[0], shoulders[1]), add_stick(world, hips[0], hips[1]);
  for (const int i : {0, 1}) {
    add_stick(world, shoulders[i], hips[0]), add_stick(world, shoulders[i], hips[1]);
    add_stick(world, head, shoulders[i]), add_stick(world, head, hips[i], 0.9);
  }
  for (const int i : {0, 1}) {
    const double side = 2 * i - 1;
    const BodyId elbow = doll.point("elbow", on_side(side, kElbow), kElbowMass, kArmRadius);
    const BodyId hand = doll.point("hand", on_side(side, kHand), kHandMass, kArmRadius);
    add_stick(world, shoulders[i], elbow), add_stick(world, elbow, hand);
    add_stick(world, shoulders[i], hand, 0.4);
    const BodyId knee = doll.point("knee", on_side(side, kKnee), kKneeMass, kShinRadius);
    const BodyId foot = doll.point("foot", on_side(side, kFoot), kFootMass, kShinRadius);
    add_stick(world, hips[i], knee), add_stick(world, knee, foot);
    add_stick(world, hips[i], foot, 0.5);
  }
}

}  // namespace plumb::demos
