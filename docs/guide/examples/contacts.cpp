// Begin, end and hit events, a sensor, filters, and a platform that is solid from above only.
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  enum : std::uint32_t { kScenery = 1, kPlayer = 2, kGhost = 4 };
  const BodyId scenery = world.create_body({.type = BodyType::Static});
  world.create_shape(scenery, {.geometry = Box{40, 2}, .position = {0, -1}, .filter = {.mask = ~kGhost}});
  const ShapeId platform =
      world.create_shape(scenery, {.geometry = Box{4, 0.2}, .position = {0, 2}, .pre_solve = true});
  world.create_shape(scenery,
                     {.geometry = Box{4, 1}, .position = {0, 3}, .sensor = true});  // above the platform
  const BodyId player =
      world.create_body({.position = {0, 0.5}, .velocity = {0, 9}, .may_sleep = false},
                        {.geometry = Circle{0.5}, .filter = {.category = kPlayer}, .hit_events = true});
  const BodyId ghost =
      world.create_body({.position = {9, 1}}, {.geometry = Circle{0.5}, .filter = {.category = kGhost}});

  world.on_pre_solve([&](const ContactReading& contact) {
    const double up = contact.shape_a == platform ? contact.normal.y : -contact.normal.y;
    return up > 0.5 && world.velocity(player).y <= 0.01;  // false: not solid in this step
  });
  int touched = 0, left = 0, entered = 0;
  double hardest = 0;
  for (int i = 0; i < 180; ++i) {
    world.step();
    const Events& events = world.events();
    touched += static_cast<int>(events.begin.size()), left += static_cast<int>(events.end.size());
    entered += static_cast<int>(events.sensor_begin.size());
    for (const HitEvent& hit : events.hits) hardest = hit.speed > hardest ? hit.speed : hardest;
  }
  std::printf("on the platform at %.2f m: %d begin, %d end, %d sensor events, hardest hit %.1f m/s\n",
              world.position(player).y, touched, left, entered, hardest);
  std::printf("the ghost fell through the ground: %s\n", world.position(ghost).y < -2 ? "yes" : "no");
  return 0;
}
