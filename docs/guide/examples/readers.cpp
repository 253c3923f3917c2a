// What a world holds can be read back as definitions: a body is copied into another world.
#include <cstdio>

#include "engine/world/world.h"

namespace {

plumb::BodyId copy(const plumb::World& from, plumb::BodyId body, plumb::World& to) {
  const plumb::BodyId made = to.create_body({.type = from.type(body),
                                             .position = from.position(body),
                                             .angle = from.angle(body),
                                             .linear_damping = from.linear_damping(body),
                                             .user_data = from.user_data(body)});
  for (const plumb::ShapeId shape : from.shapes(body)) to.create_shape(made, from.definition(shape));
  to.set_velocity(made, from.velocity(body));
  to.set_angular_velocity(made, from.angular_velocity(body));
  return made;
}

}  // namespace

int main() {
  using namespace plumb;
  World game, preview;
  const BodyId lamp = game.create_body({.position = {0, 3}, .velocity = {1, 0}, .user_data = 12});
  game.create_shape(lamp, {.geometry = Box{0.1, 1}, .position = {0, -0.5}});
  game.create_shape(lamp, {.geometry = Circle{0.2}, .density = 4});
  for (int i = 0; i < 30; ++i) game.step();
  const BodyId ghost = copy(game, lamp, preview);
  std::printf("%.3f kg and %.3f kg, item %d\n", game.mass(lamp), preview.mass(ghost),
              static_cast<int>(preview.user_data(ghost)));
  for (int i = 0; i < 30; ++i) game.step(), preview.step();
  const double apart = game.position(lamp).y - preview.position(ghost).y;
  std::printf("half a second later they are %s\n", apart * apart < 1e-10 ? "together" : "apart");
  return 0;
}
