// Gears that mesh, a ratchet that lets them turn one way, and a pulley that lifts a load.
#include <cmath>
#include <cstdio>
#include <optional>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  const BodyId frame = world.create_body({.type = BodyType::Static});
  const auto wheel = [&](double x, double radius, std::optional<Motor> motor) {
    const BodyId body =
        world.create_body({.position = {x, 0}, .may_sleep = false}, {.geometry = Circle{radius}});
    world.create_joint(frame, body, {.kind = RevoluteDefinition{.anchor_a = {x, 0}, .motor = motor}});
    return body;
  };
  const BodyId large = wheel(0, 1, Motor{.speed = 2, .max_force = 50}), small = wheel(1.5, 0.5, std::nullopt);
  world.create_joint(large, small, {.kind = GearDefinition{.ratio = -2}});  // small = -2 large

  const BodyId winch = wheel(5, 0.5, std::nullopt);
  world.create_joint(frame, winch, {.kind = RatchetDefinition{.tooth = 0.1}});  // counter-clockwise is free

  const ShapeDefinition heavy{.geometry = Box{0.5, 0.5}, .density = 8},
      light{.geometry = Box{0.5, 0.5}, .density = 4};
  const BodyId down = world.create_body({.position = {9, -2}}, heavy);
  const BodyId up = world.create_body({.position = {11, -2}}, light);
  world.create_joint(down, up, {.kind = PulleyDefinition{.ground_a = {9, 2}, .ground_b = {11, 2}}});

  for (int i = 0; i < 90; ++i) {
    world.apply_torque(winch, i < 20 ? 1 : -1);  // up, then back
    world.step();
  }
  std::printf("gears %.2f and %.2f rad/s, winch held at %.2f rad, %.2f rad/s\n",
              world.angular_velocity(large), world.angular_velocity(small), world.angle(winch),
              std::abs(world.angular_velocity(winch)));
  std::printf("pulley: %.2f m/s down, %.2f m/s up\n", -world.velocity(down).y, world.velocity(up).y);
  return 0;
}
