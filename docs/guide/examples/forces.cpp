// Forces beyond gravity: water, wind, drag, a rubber band, a planet, a law of one's own, and an explosion.
#include "engine/world/force_laws.h"

#include <cstdio>

int main() {
  using namespace plumb;
  World world({.sleeping = false});
  const double dt = 1.0 / 60;
  const ShapeDefinition wood{.geometry = Box{1, 1}, .density = 600};
  const BodyId raft = world.create_body({.name = "raft", .position = {0, 1}}, wood);
  const BodyId kite = world.create_body({.name = "kite", .position = {3, 9}, .user_data = 1},
                                        ShapeDefinition{.geometry = Box{1, 1}, .density = 0.5});

  for (int step = 0; step < 600; ++step) {
    apply_water(world, {.level = 0, .density = 1000, .linear_drag = 2000, .angular_drag = 500}, dt);
    apply_wind(world, {.velocity = {2, 0}, .density = 1.2}, dt);
    apply_spring(world, raft, {0, 0.5}, kite, {0, 0},
                 {.stiffness = 40, .damping = 2, .rest_length = 6, .pulls_only = true}, dt);
    apply_attraction(world, {0, 200}, {.strength = 10}, dt);
    // Hot air under the kite alone.
    apply_law(world, [](const LawBody& body) -> Wrench<double> {
      return {{0, body.user_data == 1 ? 20 * body.mass : 0}, 0};
    });
    apply_linear_drag(world, {.linear = 0.1, .angular = 0.1}, dt);  // last: it knows the forces before it
    world.step(dt);
  }
  const Vec2d floats = world.centre(raft), flies = world.centre(kite);
  explode(world, {.centre = {floats.x - 2, floats.y}, .radius = 4, .impulse = 900});
  std::printf("the raft floats at %.2f m, the kite flies at %.1f m, the blast drives the raft at %.2f m/s\n",
              floats.y, flies.y, world.velocity(raft).x);
  return floats.y > -0.5 && floats.y < 0.5 && flies.y > 2 ? 0 : 1;
}
