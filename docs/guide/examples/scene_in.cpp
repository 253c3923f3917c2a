// A scene, as every engine of the harness runs it, becomes part of a game's world.
#include <cstdio>

#include "engine/scene/json.h"
#include "engine/world/add_scene.h"

int main() {
  using namespace plumb;
  const Scene scene = scene_from_json(R"({
    "gravity": [0, -10],
    "bodies": [
      {"name": "ground", "type": "static", "position": [0, -1],
       "shapes": [{"type": "box", "width": 40, "height": 2}]},
      {"name": "crate", "position": [0, 4], "mass": 3,
       "shapes": [{"type": "box", "width": 1, "height": 1}]}
    ]
  })");
  World world(world_definition(scene));
  const SceneParts parts = add_scene(world, scene);
  const BodyId crate = parts.bodies[1];
  world.create_body({.position = {0, 8}}, {.geometry = Circle{0.5}});  // the game adds its own
  for (int i = 0; i < 120; ++i) world.step();
  std::printf("%s of %.0f kg lies at %.2f m\n", world.name(crate).c_str(), world.mass(crate),
              world.position(crate).y);
  return 0;
}
