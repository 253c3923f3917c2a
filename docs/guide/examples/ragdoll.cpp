// A ragdoll: joints with limits, parts that touch each other only where they are not joined.
#include <algorithm>
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{60, 2}});
  world.create_body({.type = BodyType::Static, .position = {0.4, 1}}, {.geometry = Circle{0.5}});
  const auto part = [&](double x, double y, double width, double height) {
    return world.create_body({.position = {x, y}}, {.geometry = Box{width, height}, .density = 100});
  };
  const BodyId torso = part(0, 4, 0.4, 0.8);
  const auto attach = [&](BodyId limb, Vec2d at, Range limits) {
    return world.create_joint(torso, limb,
                              {.kind = RevoluteDefinition{.anchor_a = world.local_point(torso, at),
                                                          .anchor_b = world.local_point(limb, at),
                                                          .limits = limits},
                               .collide = false});  // the default: a joint's own bodies overlap freely
  };
  const JointId joints[] = {attach(part(0, 4.6, 0.3, 0.3), {0, 4.4}, {-0.5, 0.5}),
                            attach(part(-0.5, 4.3, 0.6, 0.15), {-0.2, 4.3}, {-1.5, 1.5}),
                            attach(part(0.5, 4.3, 0.6, 0.15), {0.2, 4.3}, {-1.5, 1.5}),
                            attach(part(-0.15, 3.2, 0.2, 0.8), {-0.15, 3.6}, {-1, 0.6}),
                            attach(part(0.15, 3.2, 0.2, 0.8), {0.15, 3.6}, {-0.6, 1})};
  double past_limit = 0;
  for (int i = 0; i < 900; ++i) {
    world.step();
    for (const JointId joint : joints) {
      const Range limits = *std::get<RevoluteDefinition>(world.kind(joint)).limits;
      const double angle = world.read(joint).angle;
      past_limit = std::max({past_limit, limits.lower - angle, angle - limits.upper});
    }
  }
  std::printf("%s, never more than 2 degrees past a limit: %s\n", world.awake(torso) ? "moves" : "sleeps",
              past_limit < 0.035 ? "yes" : "no");
  return past_limit < 0.035 ? 0 : 1;
}
