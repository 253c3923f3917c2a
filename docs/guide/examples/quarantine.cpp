// A law of force divides by zero for one body. It is taken out of the motion and told; the others go on.
#include <cmath>
#include <cstdio>

#include "engine/world/force_laws.h"

int main() {
  using namespace plumb;
  World world;
  const BodyId star = world.create_body({.type = BodyType::Static, .position = {0, 0}});
  world.set_gravity({0, 0});
  const BodyId moon =
      world.create_body({.name = "moon", .position = {4, 0}, .velocity = {0, 10}}, {.density = 2});
  const BodyId probe = world.create_body({.name = "probe", .velocity = {0, 0}}, {.geometry = Circle{0.1}});

  const auto fall_to_star = [&](const LawBody& body) -> Wrench<double> {
    const Vec2d way = world.position(star) - body.centre;
    const double r2 = length_squared(way);  // 0 for the probe, which starts in the star
    return {(100 * body.mass / r2) * way, 0};
  };
  for (int step = 0; step < 120; ++step) {
    apply_law(world, fall_to_star);
    world.step();
    for (const QuarantineEvent& event : world.events().quarantined) {
      std::printf("step %lld: %s of '%s' is %g\n", static_cast<long long>(event.step),
                  kBadFieldNames[static_cast<int>(event.field)], event.name.c_str(), event.value);
    }
    if (step == 60) {  // set right, and let go
      world.set_position(probe, {0, 2}, 0);
      world.set_velocity(probe, {-10, 0});
      world.release(probe);
    }
  }
  std::printf("in quarantine: %zu; the moon is %.1f m from the star\n", world.quarantined().size(),
              std::sqrt(length_squared(world.position(moon))));
  return world.quarantined().empty() && world.velocity(probe) != Vec2d{} ? 0 : 1;
}
