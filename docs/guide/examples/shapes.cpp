// All shapes, a compound, a chain of ground, and where the masses come from.
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  const BodyId ground = world.create_body({.type = BodyType::Static});
  world.create_chain(ground,
                     {.points = {{40, 3}, {30, 0}, {-30, 0}, {-40, 3}}});  // leftwards: the front is up
  world.create_shape(ground, {.geometry = Segment{{-12, 0}, {-12, 4}}});

  const ShapeDefinition shapes[] = {
      {.geometry = Circle{0.5}},
      {.geometry = Capsule{{0, -0.3}, {0, 0.3}, 0.2}},
      {.geometry = Box{1, 0.6}},
      {.geometry = Polygon{{{-0.5, -0.4}, {0.5, -0.4}, {0, 0.5}}}},
      {.geometry = Polygon{{{-0.4, -0.4}, {0.4, -0.4}, {0.4, 0.4}, {-0.4, 0.4}}, 0.1}},  // rounded by 0.1 m
  };
  double x = -8;
  for (const ShapeDefinition& shape : shapes) world.create_body({.position = {x += 2, 1}}, shape);

  // A hammer: the head is denser, so the centre of mass lies near it.
  const ShapeDefinition hammer[] = {
      {.geometry = Box{0.1, 1}, .density = 1},
      {.geometry = Box{0.5, 0.2}, .position = {0, 0.5}, .density = 8},
  };
  const BodyId tool = world.create_body({.position = {6, 2}}, hammer);
  std::printf("hammer: %.2f kg, centre of mass %.2f m above its origin, inertia %.3f kg m^2\n",
              world.mass(tool), world.centre(tool).y - world.position(tool).y, world.inertia(tool));
  world.set_mass(tool, {.mass = 3, .centre = {0, 0.1}, .inertia = 0.5});

  for (int i = 0; i < 300; ++i) world.step();
  std::printf("%d of %d bodies rest\n", world.counts().bodies - 1 - world.counts().awake,
              world.counts().bodies - 1);
  return 0;
}
