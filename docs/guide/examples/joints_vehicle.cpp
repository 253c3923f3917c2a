// A car: two wheels on springs, one of them driven.
#include <cstdio>
#include <variant>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{200, 2}});
  const BodyId chassis = world.create_body({.position = {0, 1}}, {.geometry = Box{3, 0.6}, .density = 50});
  const auto add_wheel = [&](double x, double torque) {
    const BodyId wheel = world.create_body(
        {.position = {x, 0.5}}, {.geometry = Circle{0.5}, .density = 10, .material = {.friction = 1}});
    return world.create_joint(chassis, wheel,
                              {.kind = WheelDefinition{.anchor_a = {x, -0.5},
                                                       .axis = {0, 1},
                                                       .spring = Spring{.hertz = 4, .damping_ratio = 0.7},
                                                       .limits = Range{-0.2, 0.2},
                                                       .motor = Motor{.speed = 0, .max_force = torque}}});
  };
  const JointId rear = add_wheel(-1, 150);
  add_wheel(1, 0);

  const auto drive = [&](double speed) {  // m/s; wheels turn clockwise to roll to the right
    WheelDefinition wheel = std::get<WheelDefinition>(world.kind(rear));
    wheel.motor->speed = -speed / 0.5;
    world.change(rear, wheel);
  };
  drive(5);
  for (int i = 0; i < 300; ++i) world.step();
  std::printf("the car runs at %.2f m/s, %.2f m high\n", world.velocity(chassis).x,
              world.position(chassis).y);
  drive(0);
  for (int i = 0; i < 300; ++i) world.step();
  std::printf("and stands after braking: %.2f m/s\n", world.velocity(chassis).x);
  return 0;
}
