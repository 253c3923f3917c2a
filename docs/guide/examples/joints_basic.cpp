// Rod, spring and rope (distance), a door (revolute), a drawer (prismatic), and a joint that breaks.
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  const BodyId frame = world.create_body({.type = BodyType::Static});
  const ShapeDefinition load{.geometry = Box{0.4, 0.4}, .density = 10};  // 1.6 kg
  const auto body = [&](double x, double y) { return world.create_body({.position = {x, y}}, load); };
  const auto hang = [&](BodyId b, DistanceDefinition joint) {
    joint.anchor_a = {world.position(b).x, 10};
    return world.create_joint(frame, b, {.kind = joint});
  };
  const JointId rod = hang(body(0, 8), {.length = 2});
  const JointId spring = hang(body(2, 8), {.length = 2, .spring = Spring{.hertz = 1, .damping_ratio = 0.5}});
  const JointId rope = hang(body(4, 9), {.length = 3, .range = Range{0, 3}});

  const JointId door = world.create_joint(
      frame, body(7, 10),
      {.kind = RevoluteDefinition{.anchor_a = {6, 10}, .anchor_b = {-1, 0}, .limits = Range{-0.5, 0.5}}});
  const JointId drawer = world.create_joint(
      frame, body(10, 10),
      {.kind = PrismaticDefinition{.anchor_a = {10, 10}, .limits = Range{0, 1}, .motor = Motor{0.5, 20}}});
  const JointId thread = world.create_joint(
      frame, body(13, 10), {.kind = RevoluteDefinition{.anchor_a = {13, 10}}, .break_force = 10});

  bool broke = false;
  for (int i = 0; i < 300; ++i) {
    world.step();
    for (const JointEvent& event : world.events().broken) broke = broke || event.joint == thread;
  }
  std::printf("rod %.2f m pulled by %.1f N, spring %.2f m, rope %.2f m\n", world.read(rod).length,
              world.read(rod).force, world.read(spring).length, world.read(rope).length);
  std::printf("door at %.2f rad, drawer out by %.2f m, thread %s\n", world.read(door).angle,
              world.read(drawer).translation, broke ? "broke" : "holds");
  return broke && !world.valid(thread) ? 0 : 1;
}
