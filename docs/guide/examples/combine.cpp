// A combine rule of one's own: what is slippery stays slippery, whatever it lies on.
#include <cstdio>

#include "engine/world/world.h"

namespace {

// The harmonic mean: nearer to the smaller one, 0 if either is.
double harmonic_mean(double a, double b) { return a + b > 0 ? 2 * a * b / (a + b) : 0; }

}  // namespace

int main() {
  using namespace plumb;
  World world({.sleeping = false});
  world.combine_with(harmonic_mean, nullptr);  // friction; restitution stays the larger of both
  world.create_body({.type = BodyType::Static, .position = {0, -0.5}},
                    {.geometry = Box{60, 1}, .material = {.friction = 0.6}});
  const ShapeDefinition ice{.geometry = Box{2, 0.5}, .material = {.friction = 0.2}};
  const BodyId sled = world.create_body({.position = {0, 0.25}, .velocity = {4, 0}, .user_data = 42}, ice);
  for (int i = 0; i < 30; ++i) world.step();
  std::printf("after half a second the sled has lost %.2f m/s\n", 4 - world.velocity(sled).x);
  return 0;
}
