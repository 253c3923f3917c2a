// Friction, restitution, rolling resistance and a conveyor, each on ground of its own.
#include <cmath>
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world({.combine_friction = Combine::Minimum, .sleeping = false});
  const auto ground = [&](double y, Material material) {
    return world.create_body({.type = BodyType::Static, .position = {0, y - 0.5}},
                             {.geometry = Box{60, 1}, .material = material});
  };
  ground(0, {.friction = 0.2});  // ice
  ground(10, {.restitution = 0.8});
  ground(20, {.friction = 1});
  const BodyId belt = ground(30, {.friction = 1, .surface_speed = 1.5});

  const BodyId sled =
      world.create_body({.position = {0, 0.25}, .velocity = {4, 0}}, {.geometry = Box{2, 0.5}});
  const BodyId ball = world.create_body({.position = {0, 12.5}}, {.geometry = Circle{0.5}});
  const BodyId wheel =
      world.create_body({.position = {0, 20.5}, .velocity = {3, 0}, .angular_velocity = -6},
                        {.geometry = Circle{0.5}, .material = {.friction = 1, .rolling_resistance = 0.05}});
  const BodyId parcel = world.create_body({.position = {0, 30.25}}, {.geometry = Box{0.5, 0.5}});

  double top = 0;
  for (int i = 0; i < 75; ++i) {
    world.step();
    if (world.velocity(ball).y > 0) top = std::fmax(top, world.position(ball).y - 10.5);
  }
  std::printf("sled %.2f m/s, ball bounced to %.2f of 2 m, wheel %.2f m/s, parcel %.2f m/s\n",
              world.velocity(sled).x, top, world.velocity(wheel).x, world.velocity(parcel).x);
  for (const ShapeId shape : world.shapes(belt)) world.set_material(shape, {.friction = 1});  // switched off
  for (int i = 0; i < 60; ++i) world.step();
  std::printf("the belt stands, the parcel too: %.2f m/s\n", std::abs(world.velocity(parcel).x));
  return 0;
}
