// A picture of a world as the engine sees it: debug_draw.svg where this runs, or the path that is given.
#include <fstream>

#include "engine/world/debug_draw.h"
#include "engine/world/svg_draw.h"

int main(int count, char** arguments) {
  plumb::World world;
  const plumb::BodyId ground = world.create_body({.name = "ground", .type = plumb::BodyType::Static},
                                                 {.geometry = plumb::Box{10, 0.5}, .position = {0, -0.25}});
  world.create_shape(ground, {.geometry = plumb::Box{2, 1.5}, .position = {-3.5, 0.75}, .sensor = true});
  world.create_body({.type = plumb::BodyType::Kinematic, .position = {-3, 1}, .velocity = {0.2, 0}},
                    {.geometry = plumb::Capsule{{-0.5, 0}, {0.5, 0}, 0.1}});
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i < 3 - row; ++i)
      world.create_body({.position = {1.1 * i + 0.55 * row, 0.5 + row}}, {.geometry = plumb::Box{1, 1}});
  }
  const plumb::BodyId asleep = world.create_body({.position = {4, 0.4}}, {.geometry = plumb::Circle{0.4}});
  plumb::BodyId previous = world.create_body({.type = plumb::BodyType::Static, .position = {-2, 3.5}});
  for (int i = 0; i < 4; ++i) {
    const plumb::BodyId link = world.create_body({.position = {-1.7 + 0.6 * i, 3.5}},
                                                 {.geometry = plumb::Capsule{{-0.2, 0}, {0.2, 0}, 0.1}});
    world.create_joint(
        previous, link,
        {.kind = plumb::RevoluteDefinition{.anchor_a = {i == 0 ? 0 : 0.3, 0}, .anchor_b = {-0.3, 0}}});
    previous = link;
  }
  for (int i = 0; i < 25; ++i) world.step();
  world.set_awake(asleep, false);

  plumb::SvgDraw svg;
  draw(world, svg, {.contacts = true, .normals = true, .boxes = true, .centres = true, .names = true});
  std::ofstream(count > 1 ? arguments[1] : "debug_draw.svg") << svg.picture();
  return 0;
}
